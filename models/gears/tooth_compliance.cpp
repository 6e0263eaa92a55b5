#include "models/gears/tooth_compliance.hpp"

#include <drev/core/error.hpp>
#include <drev/core/units.hpp>

#include <algorithm>
#include <cmath>

#include "core/dense/factorization.hpp"
#include "models/gears/tooth_sector.hpp"
#include "solvers/linear/sparse_cholesky.hpp"

namespace drev {
namespace {

using Matrix = Eigen::MatrixXd;
constexpr int kPlaces = 15;  // Chebyshev places

double chebyshev(int i, int count) { return -std::cos(kPi * (i + 0.5) / count); }

/// Stiffness of a chain of sectors at its right and left border.
struct Chain {
  Matrix rr, rl, ll;
};

/// first, then second further on.
Chain joined(const Chain& first, const Chain& second) {
  const CholeskyFactor middle(first.ll + second.rr);
  const Matrix to_right = middle.solve(Matrix(first.rl.transpose())), to_left = middle.solve(second.rl);
  return {first.rr - first.rl * to_right, -first.rl * to_left, second.ll - second.rl.transpose() * to_left};
}

Chain repeated(const Chain& one, int count) {
  Chain power = one, product;
  bool any = false;
  for (int n = count; n > 0; n /= 2) {
    if (n % 2 == 1) product = any ? joined(product, power) : power, any = true;
    if (n > 1) power = joined(power, power);
  }
  return product;
}

/// One sector, factored, with its borders to the next ones.
class Sector {
 public:
  Sector(const GearPair& pair, int gear, int level);

  struct Response {
    double own;     // displacement at the force, borders held
    Vector border;  // forces that hold the borders: right, then left, radial and around
  };
  Response load(double t);  // t in modules
  /// What a unit displacement of the borders takes.
  Chain chain();
  int unknowns() const { return static_cast<int>(free_.size()); }

 private:
  static std::size_t at(int n) { return static_cast<std::size_t>(n); }
  PlanePoint place(const ToothSector::Edge& edge, double u, PlanePoint& slope) const;
  void add_traction(const ToothSector::Edge& edge, const FlamantField& field, PlanePoint origin, double from,
                    double to, int depth, Vector& force) const;
  /// Free unknowns that balance `force` with the held ones as they are in `u`.
  void solve(const Vector& force, Vector& u);
  double border_row(std::size_t i, const Vector& u,
                    const Vector* force) const;  // K u - force at border unknown i

  ToothSector sector_;
  double poisson_;
  SparseMatrix stiffness_, inner_;
  std::vector<int> free_, place_of_;         // unknowns that are solved for; their numbers, -1: held
  std::vector<int> held_;                    // unknowns of borders and bore
  std::vector<std::array<double, 2>> axes_;  // of border unknowns, in x and y
  std::vector<int> border_nodes_;
  SparseCholesky factor_;
  Vector rhs_, solution_;
};

Sector::Sector(const GearPair& pair, int gear, int level)
    : sector_(tooth_sector(pair, gear, level)), poisson_(pair.gear(gear).material.poisson_ratio) {
  try {
    stiffness_ = plane_stiffness(sector_.mesh, sector_.material);
  } catch (const SolverError& error) {
    throw ModelError(
        {{"gear_" + std::to_string(gear + 1), pair.is_ring(gear) ? "outer_diameter" : "bore_diameter",
          to_text(2.0 * pair.held_radius(gear)), "m",
          std::string("leaves a body that cannot be meshed with this tooth: ") + error.what()}});
  }
  place_of_.assign(at(static_cast<int>(stiffness_.rows())), 0);
  const double half = kPi / pair.gear(gear).teeth, up = pair.contour(gear).side();
  for (const std::vector<int>* nodes : {&sector_.right, &sector_.left, &sector_.bore})
    for (const int node : *nodes)
      for (const int d : {0, 1})
        if (place_of_[at(2 * node + d)] == 0) place_of_[at(2 * node + d)] = -1, held_.push_back(2 * node + d);
  for (const double side : {1.0, -1.0})
    for (const int node : side > 0.0 ? sector_.right : sector_.left) {
      border_nodes_.insert(border_nodes_.end(), {node, node});
      axes_.push_back({side * std::sin(half), up * std::cos(half)});
      axes_.push_back({-up * std::cos(half), side * std::sin(half)});
    }
  for (std::size_t i = 0; i < place_of_.size(); ++i)
    if (place_of_[i] >= 0)
      place_of_[i] = static_cast<int>(free_.size()), free_.push_back(static_cast<int>(i));
  // The matrix of the free unknowns, in the same order.
  inner_.resize(static_cast<int>(free_.size()), static_cast<int>(free_.size()));
  inner_.reserve(stiffness_.nonZeros());
  for (std::size_t j = 0; j < free_.size(); ++j) {
    inner_.startVec(static_cast<int>(j));
    for (SparseMatrix::InnerIterator it(stiffness_, free_[j]); it; ++it)
      if (place_of_[at(static_cast<int>(it.row()))] >= 0)
        inner_.insertBack(place_of_[at(static_cast<int>(it.row()))], static_cast<int>(j)) = it.value();
  }
  inner_.finalize();
  const Vector values = Eigen::Map<const Vector>(inner_.valuePtr(), inner_.nonZeros());
  if (factor_.factorize(inner_, values) != FactorStatus::success)
    throw SolverError(std::string("the stiffness of a gear's tooth cannot be factored: ") +
                      to_text(factor_.status()));
}

void Sector::solve(const Vector& force, Vector& u) {
  rhs_.resize(static_cast<Eigen::Index>(free_.size()));
  for (std::size_t i = 0; i < free_.size(); ++i) rhs_[static_cast<Eigen::Index>(i)] = force[free_[i]];
  for (const int column : held_) {
    if (u[column] == 0.0) continue;
    for (SparseMatrix::InnerIterator it(stiffness_, column); it; ++it) {
      const int row = place_of_[at(static_cast<int>(it.row()))];
      if (row >= 0) rhs_[row] -= it.value() * u[column];
    }
  }
  factor_.solve(rhs_, solution_);
  for (std::size_t i = 0; i < free_.size(); ++i) u[free_[i]] = solution_[static_cast<Eigen::Index>(i)];
}

double Sector::border_row(std::size_t i, const Vector& u, const Vector* force) const {
  double sum = 0.0;
  for (const int d : {0, 1}) {
    const int row = 2 * border_nodes_[i] + d;
    double product = force ? -(*force)[row] : 0.0;
    for (SparseMatrix::InnerIterator it(stiffness_, row); it; ++it) product += it.value() * u[it.row()];
    sum += axes_[i][at(d)] * product;
  }
  return sum;
}

/// The sector is its own mirror image: columns of the left border are those of the right one, with the displacements
/// around the axis turned round.
Chain Sector::chain() {
  const auto n = static_cast<Eigen::Index>(border_nodes_.size()), half = n / 2;
  Matrix right(n, half);
  const Vector none = Vector::Zero(stiffness_.rows());
  Vector u;
  for (Eigen::Index j = 0; j < half; ++j) {
    u.setZero(stiffness_.rows());
    for (const int d : {0, 1})
      u[2 * border_nodes_[at(static_cast<int>(j))] + d] = axes_[at(static_cast<int>(j))][at(d)];
    solve(none, u);
    for (Eigen::Index i = 0; i < n; ++i) right(i, j) = border_row(at(static_cast<int>(i)), u, nullptr);
  }
  Chain one{right.topRows(half), right.bottomRows(half).transpose(), right.topRows(half)};
  for (Eigen::Index i = 0; i < half; ++i)
    for (Eigen::Index j = 0; j < half; ++j)
      if ((i + j) % 2 == 1) one.ll(i, j) = -one.ll(i, j);
  return one;
}

PlanePoint Sector::place(const ToothSector::Edge& edge, double u, PlanePoint& slope) const {
  const std::array<double, 3> n{0.5 * u * (u - 1.0), 1.0 - u * u, 0.5 * u * (u + 1.0)},
      dn{u - 0.5, -2.0 * u, u + 0.5};
  PlanePoint p{};
  slope = {};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t d = 0; d < 2; ++d) {
      p[d] += n[k] * sector_.mesh.nodes[at(edge[k])][d];
      slope[d] += dn[k] * sector_.mesh.nodes[at(edge[k])][d];
    }
  return p;
}

/// Edges near the force are halved until they are shorter than their distance from it.
void Sector::add_traction(const ToothSector::Edge& edge, const FlamantField& field, PlanePoint origin,
                          double from, double to, int depth, Vector& force) const {
  static const std::array<double, 4> places{-0.8611363115940526, -0.3399810435848563, 0.3399810435848563,
                                            0.8611363115940526};
  static const std::array<double, 4> weights{0.3478548451374538, 0.6521451548625461, 0.6521451548625461,
                                             0.3478548451374538};
  PlanePoint slope;
  const PlanePoint middle = place(edge, 0.5 * (from + to), slope);
  const double length = std::hypot(slope[0], slope[1]) * (to - from);
  if (depth > 0 && std::hypot(middle[0] - origin[0], middle[1] - origin[1]) < 1.2 * length) {
    add_traction(edge, field, origin, from, 0.5 * (from + to), depth - 1, force);
    add_traction(edge, field, origin, 0.5 * (from + to), to, depth - 1, force);
    return;
  }
  for (std::size_t k = 0; k < 4; ++k) {
    const double u = 0.5 * (from + to) + 0.5 * (to - from) * places[k];
    const PlanePoint p = place(edge, u, slope);
    const double size = std::hypot(slope[0], slope[1]), weight = 0.5 * (to - from) * weights[k] * size;
    const PlanePoint t = field.traction(p, {slope[1] / size, -slope[0] / size});
    const std::array<double, 3> n{0.5 * u * (u - 1.0), 1.0 - u * u, 0.5 * u * (u + 1.0)};
    for (std::size_t i = 0; i < 3; ++i)
      for (const int d : {0, 1}) force[2 * edge[i] + d] -= weight * n[i] * t[at(d)];
  }
}

Sector::Response Sector::load(double t) {
  const std::vector<double>& ends = sector_.flank_lengths;
  const bool rises = ends.back() > ends.front();
  const auto above = std::upper_bound(ends.begin() + 1, ends.end() - 1, t,
                                      [rises](double a, double b) { return rises ? a < b : a > b; });
  const auto which = static_cast<std::size_t>(above - ends.begin()) - 1;
  const ToothSector::Edge& edge = sector_.flank[which];
  // Where on the edge the radius is that of t: base radius from the edge's first node.
  const PlanePoint& first = sector_.mesh.nodes[at(edge[0])];
  const double base = first[0] * first[0] + first[1] * first[1] - std::pow(sector_.flank_lengths[which], 2);
  double u = 2.0 * (t - *(above - 1)) / (*above - *(above - 1)) - 1.0;
  PlanePoint slope, origin;
  for (int i = 0; i < 6; ++i) {
    origin = place(edge, u, slope);
    u -= (origin[0] * origin[0] + origin[1] * origin[1] - base - t * t) /
         (2.0 * (origin[0] * slope[0] + origin[1] * slope[1]));
    u = std::clamp(u, -1.0, 1.0);
  }
  origin = place(edge, u, slope);
  const double size = std::hypot(slope[0], slope[1]);
  const PlanePoint inwards{-slope[1] / size, slope[0] / size};
  const FlamantField field(origin, inwards, poisson_);
  Vector force = Vector::Zero(stiffness_.rows()), displacement = force;
  for (const ToothSector::Edge& each : sector_.edges) add_traction(each, field, origin, -1.0, 1.0, 12, force);
  for (const int unknown : held_)
    if (unknown % 2 == 0) {
      const PlanePoint there = field.displacement(sector_.mesh.nodes[at(unknown / 2)]);
      displacement[unknown] = -there[0];
      displacement[unknown + 1] = -there[1];
    }
  solve(force, displacement);
  Response response{0.0, Vector(static_cast<Eigen::Index>(border_nodes_.size()))};
  const std::array<double, 3> n{0.5 * u * (u - 1.0), 1.0 - u * u, 0.5 * u * (u + 1.0)};
  for (std::size_t k = 0; k < 3; ++k)
    for (const int d : {0, 1}) response.own += n[k] * displacement[2 * edge[k] + d] * inwards[at(d)];
  for (std::size_t i = 0; i < border_nodes_.size(); ++i)
    response.border[static_cast<Eigen::Index>(i)] = border_row(i, displacement, &force);
  return response;
}

/// Displacements of the borders of sector 0 to `neighbours` by unit forces on those of sector 0, all z sectors joined:
/// rows of sector d begin at d times the unknowns of one border.
Matrix ring_compliance(const Chain& one, int teeth, int neighbours) {
  const Eigen::Index n = one.rr.rows();
  const Chain rest = repeated(one, teeth - neighbours - 1);
  Matrix ring = Matrix::Zero((neighbours + 2) * n, (neighbours + 2) * n);
  for (Eigen::Index j = 0; j <= neighbours; ++j) {
    ring.block(j * n, j * n, n, n) += one.rr;
    ring.block(j * n, (j + 1) * n, n, n) += one.rl;
    ring.block((j + 1) * n, j * n, n, n) += one.rl.transpose();
    ring.block((j + 1) * n, (j + 1) * n, n, n) += one.ll;
  }
  const Eigen::Index last = (neighbours + 1) * n;
  ring.block(last, last, n, n) += rest.rr;
  ring.block(last, 0, n, n) += rest.rl;
  ring.block(0, last, n, n) += rest.rl.transpose();
  ring.block(0, 0, n, n) += rest.ll;
  Matrix unit = Matrix::Zero(ring.rows(), 2 * n);
  unit.topLeftCorner(2 * n, 2 * n).setIdentity();
  return CholeskyFactor(ring).solve(unit);
}

void check_body(const GearPair& pair, int gear) {
  const GearData& g = pair.gear(gear);
  std::vector<Finding> findings;
  ParameterCheck check("gear_" + std::to_string(gear + 1), findings);
  const char* held = "must be given and > 0: where the body is held decides its stiffness";
  if (pair.is_ring(gear) && !(g.outer_diameter > 0.0))
    check.fail("outer_diameter", to_text(g.outer_diameter), "m", held);
  if (!pair.is_ring(gear) && !(g.bore_diameter > 0.0))
    check.fail("bore_diameter", to_text(g.bore_diameter), "m", held);
  if (!findings.empty()) throw ModelError(std::move(findings));
}

}  // namespace

ToothCompliance::ToothCompliance(const GearPair& pair, int gear, double low, double high, int level)
    : low_(low), high_(high) {
  check_body(pair, gear);
  const double m = pair.geometry().module;
  const int teeth = pair.gear(gear).teeth;
  Sector sector(pair, gear, level);
  unknowns_ = sector.unknowns();
  neighbours_ = std::min(kNeighbours, static_cast<int>(std::ceil(pair.contact_ratio())));
  const Matrix ring = ring_compliance(sector.chain(), teeth, neighbours_);
  const Eigen::Index n = ring.cols() / 2;
  Matrix border(2 * n, kPlaces);
  std::vector<double> held;
  const auto place = [&](int i) { return 0.5 * (low + high + (high - low) * chebyshev(i, kPlaces)) / m; };
  for (int i = 0; i < kPlaces; ++i) {
    Sector::Response response = sector.load(place(i));
    border.col(i) = response.border;
    held.push_back(response.own);
  }
  const Matrix moved = ring * border;
  const bool reversed = pair.is_ring(gear);  // the next sector's t is larger: load and response change places
  for (int i = 0; i < kPlaces; ++i) {
    own_.push_back(held[static_cast<std::size_t>(i)] + border.col(i).dot(moved.col(i).head(2 * n)));
    for (int d = 1; d <= neighbours_; ++d)
      for (int j = 0; j < kPlaces; ++j)
        coupling_[static_cast<std::size_t>(d - 1)].push_back(
            border.col(reversed ? i : j).dot(moved.col(reversed ? j : i).segment(d * n, 2 * n)));
  }
}

/// Lagrange's polynomials on the Chebyshev places, by the barycentric formula.
std::vector<double> ToothCompliance::weights_at(double t) const {
  std::vector<double> w(kPlaces);
  const double x = (2.0 * t - low_ - high_) / (high_ - low_);
  double sum = 0.0;
  for (int i = 0; i < kPlaces; ++i) {
    const double gap = x - chebyshev(i, kPlaces), sign = i % 2 == 0 ? 1.0 : -1.0;
    if (std::abs(gap) < 1e-14) {
      std::fill(w.begin(), w.end(), 0.0);
      w[static_cast<std::size_t>(i)] = 1.0;
      return w;
    }
    w[static_cast<std::size_t>(i)] = sign * std::sin(kPi * (i + 0.5) / kPlaces) / gap;
    sum += w[static_cast<std::size_t>(i)];
  }
  for (double& value : w) value /= sum;
  return w;
}

double ToothCompliance::own(double t) const {
  const std::vector<double> w = weights_at(t);
  double sum = 0.0;
  for (std::size_t i = 0; i < w.size(); ++i) sum += w[i] * own_[i];
  return sum;
}

double ToothCompliance::coupling(int d, double t_load, double t_response) const {
  if (d > neighbours_) return 0.0;
  const std::vector<double> load = weights_at(t_load), response = weights_at(t_response);
  const std::vector<double>& table = coupling_[static_cast<std::size_t>(d - 1)];
  double sum = 0.0;
  for (std::size_t i = 0; i < load.size(); ++i)
    for (std::size_t j = 0; j < response.size(); ++j)
      sum += load[i] * response[j] * table[i * response.size() + j];
  return sum;
}

double ToothCompliance::own_at(const GearPair& pair, int gear, double t, int level) {
  check_body(pair, gear);
  Sector sector(pair, gear, level);
  const Matrix ring = ring_compliance(sector.chain(), pair.gear(gear).teeth, 1);
  const Sector::Response response = sector.load(t / pair.geometry().module);
  return response.own + response.border.dot(ring.topRows(ring.cols()) * response.border);
}

}  // namespace drev
