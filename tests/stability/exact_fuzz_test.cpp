// Random piecewise-linear models: exact propagation against matrix exponentials of the pieces that
// it says hold. Between the ends of each step no bound of a piece may be violated (a missed
// change), the step's end must be that of the exponential, and the energy must balance.
#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "elements/catalogue.hpp"
#include "solvers/exact_propagation.hpp"
#include "tests/catch.hpp"
#include "tests/problems/twist_backlash.hpp"

using namespace drev;

namespace {

constexpr int kSamples = 50;

/// exp(A) by scaling, Taylor series and squaring.
Eigen::MatrixXd exponential(Eigen::MatrixXd a) {
  int halvings = 0;
  while (a.cwiseAbs().rowwise().sum().maxCoeff() > 0.5) a *= 0.5, ++halvings;
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(a.rows(), a.cols()), sum = term;
  for (int k = 1; k <= 14; ++k) sum += term = term * a / k;
  for (int i = 0; i < halvings; ++i) sum = sum * sum;
  return sum;
}

/// Watches a run: which pieces hold, and whether they may.
class PieceCheck final : public Observer {
 public:
  explicit PieceCheck(const System& system) : system_(system) {}
  void note(const ContactChange& change) { pending_.push_back(change); }

  void start(const Assembler&, const StepPoint& point) override {
    for (std::size_t j = 0; j < system_.scalars().size(); ++j) pieces_.push_back(-1);
    first_ = point.inputs;
  }

  void step(const Assembler& assembler, const StepPoint& from, const StepPoint& to) override {
    std::size_t done = 0;
    for (; done < pending_.size() && pending_[done].t <= from.state.t; ++done)
      pieces_[at(pending_[done].law)] = pending_[done].to;
    check(assembler, from, to);
    for (; done < pending_.size(); ++done) pieces_[at(pending_[done].law)] = pending_[done].to;
    pending_.clear();
  }

  double worst_bound = 0.0, worst_end = 0.0;
  long steps = 0;

 private:
  void find_first_pieces() {
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      const auto pieces = system_.scalars()[j].force->pieces();
      for (std::size_t i = 0; i < pieces.size() && pieces_[j] < 0; ++i) {
        bool inside = true;
        for (const LawBound& b : pieces[i].bounds)
          inside &= b.a + b.b_x * first_[j].x + b.b_v * first_[j].x_dot >= 0.0;
        if (inside) pieces_[j] = static_cast<int>(i);
      }
    }
  }

  void check(const Assembler& assembler, const StepPoint& from, const StepPoint& to) {
    find_first_pieces();
    const int n = system_.size();
    const double h = to.state.t - from.state.t;
    Eigen::MatrixXd m(n, n), c(n, n), k(n, n);
    Vector column(n);
    for (int i = 0; i < n; ++i) {
      const Vector unit = Vector::Unit(n, i);
      assembler.multiply_mass(unit, column), m.col(i) = column;
      assembler.multiply_damping(unit, column), c.col(i) = column;
      assembler.multiply_stiffness(unit, column), k.col(i) = column;
    }
    Vector p = from.p;
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      const LawPiece& piece = system_.scalars()[j].force->pieces()[at(pieces_[j])];
      Vector b = Vector::Zero(n);
      for (const Entry& e : system_.scalars()[j].z) b[e.index] += e.coeff;
      k += piece.k * b * b.transpose();
      c += piece.c * b * b.transpose();
      p -= piece.y_0 * b;
    }
    // d/d(t/h) (z, h v, 1, t/h), balanced: loads are linear in time over a step.
    const Eigen::MatrixXd inverse = m.inverse();
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(2 * n + 2, 2 * n + 2);
    a.block(0, n, n, n).setIdentity();
    a.block(n, 0, n, n) = -h * h * inverse * k;
    a.block(n, n, n, n) = -h * inverse * c;
    a.block(n, 2 * n, n, 1) = h * h * inverse * p;
    a.block(n, 2 * n + 1, n, 1) = h * h * inverse * (to.p - from.p);
    a(2 * n + 1, 2 * n) = 1.0;
    const Eigen::MatrixXd forward = exponential(a / kSamples);
    Vector y(2 * n + 2);
    y << from.state.z, h * from.state.v, 1.0, 0.0;
    for (const State* s : {&from.state, &to.state}) {
      z_scale_ = std::max(z_scale_, s->z.lpNorm<Eigen::Infinity>());
      v_scale_ = std::max(v_scale_, s->v.lpNorm<Eigen::Infinity>());
    }
    for (int i = 1; i <= kSamples; ++i) {
      y = forward * y;
      for (std::size_t j = 0; j < pieces_.size(); ++j) {
        double x = 0.0, x_dot = 0.0;
        for (const Entry& e : system_.scalars()[j].z) {
          x += e.coeff * y[e.index];
          x_dot += e.coeff * y[n + e.index] / h;
        }
        for (const LawBound& b : system_.scalars()[j].force->pieces()[at(pieces_[j])].bounds) {
          const double scale =
              std::abs(b.a) + std::abs(b.b_x) * z_scale_ + std::abs(b.b_v) * v_scale_;
          worst_bound = std::max(worst_bound, -(b.a + b.b_x * x + b.b_v * x_dot) / scale);
        }
      }
    }
    worst_end = std::max({worst_end, (y.head(n) - to.state.z).lpNorm<Eigen::Infinity>() / z_scale_,
                          (y.segment(n, n) / h - to.state.v).lpNorm<Eigen::Infinity>() / v_scale_});
    ++steps;
  }

  const System& system_;
  std::vector<int> pieces_;
  std::vector<ScalarInput> first_;
  std::vector<ContactChange> pending_;
  double z_scale_ = 1e-300, v_scale_ = 1e-300;
};

struct Random {
  explicit Random(unsigned seed) : engine(seed) {}
  double operator()(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine);
  }
  int below(int n) { return std::uniform_int_distribution<int>(0, n - 1)(engine); }
  std::mt19937 engine;
};

struct RandomModel {
  System system;
  double fastest;  // 1/s, rough
};

RandomModel random_model(unsigned seed) {
  Random random(seed);
  Model m("fuzz " + std::to_string(seed));
  const int masses = 1 + random.below(8), gaps = random.below(6);
  const double decades = random(0.0, 6.0), base = std::pow(10.0, random(0.0, 3.0));
  const bool damped = random.below(2) == 1;
  double stiffest = 0.0, lightest = 1e9;
  const auto stiffness = [&] {
    const double k = base * std::pow(10.0, random(0.0, decades));
    stiffest = std::max(stiffest, k);
    return k;
  };
  std::vector<double> inertia;
  for (int i = 0; i < masses; ++i) {
    const std::string n = "n" + std::to_string(i);
    m.add_node(n);
    inertia.push_back(std::pow(10.0, random(-0.7, 0.7)));
    lightest = std::min(lightest, inertia.back());
    m.add<Inertia>("J" + n, {n}, {.inertia = inertia.back()});
  }
  const auto node = [](int i) { return "n" + std::to_string(i); };
  for (int i = 1; i < masses; ++i) {
    if (random.below(5) == 0) continue;  // a gap may join them, or nothing
    const double k = stiffness();
    const std::string other = node(random.below(i));
    m.add<ShaftSpring>("shaft" + node(i), {other, node(i)}, {.stiffness = k});
    if (damped && random.below(2))
      m.add<Dashpot>("dashpot" + node(i), {other, node(i)},
                     {.damping = random(0.0, 0.1) * std::sqrt(k * inertia[at(i)])});
  }
  if (random.below(2)) m.add<GroundSpring>("ground", {node(0)}, {.stiffness = stiffness()});
  for (int g = 0; g < gaps; ++g) {
    const std::string name = "gap" + std::to_string(g);
    const int b = random.below(masses), a = random.below(masses);
    const std::vector<NodeRef> ends =
        a == b ? std::vector<NodeRef>{node(b)} : std::vector<NodeRef>{node(a), node(b)};
    const double k = stiffness(), half = random.below(6) ? random(0.01, 1.0) : 0.0;
    const double c = random.below(2) ? random(0.0, 0.5) * std::sqrt(k * inertia[at(b)]) : 0.0;
    const int kind = random.below(6);
    if (kind == 0)
      m.add(name, ends, std::make_shared<PolylineSpring>(PolylineSpring::dead_band(k, half, c)));
    else if (kind == 1)
      m.add(
          name, ends,
          std::make_shared<PolylineSpring>(PolylineSpring::with_stops(0.1 * k, half + 0.1, k, c)));
    else
      m.add(name, ends,
            std::make_shared<LawElement<TwistBacklash>>(
                TwistBacklash{BacklashLaw({.normal_backlash = 2 * half,
                                           .damping = c,
                                           .damping_law = kind == 2   ? MeshDamping::always
                                                          : kind == 3 ? MeshDamping::contact_only
                                                                      : MeshDamping::limited}),
                              k}));
  }
  const double fastest = std::sqrt(4.0 * std::max(stiffest, base) / lightest), end = 300 / fastest;
  for (int l = random.below(3); l > 0; --l) {
    const double force = random(-1.0, 1.0) * base * std::pow(10.0, random(0.0, decades));
    m.add<AppliedTorque>("load" + std::to_string(l), {node(random.below(masses))},
                         {.table = TimeTable({0.1 * end, 0.3 * end, 0.6 * end, 0.6 * end},
                                             {force, -force, 0.5 * force, 0.0})});
  }
  const double speed = fastest * std::pow(10.0, random(-2.0, 0.0));
  for (int i = 0; i < masses; ++i)
    m.set_initial(node(i), random(-1.0, 1.0), random(-1.0, 1.0) * speed);
  return {m.build(), fastest};
}

}  // namespace

TEST_CASE("Exact propagation, 300 random models: no change missed, energy kept, ends exact") {
  long changes = 0, steps = 0;
  for (unsigned seed = 1; seed <= 300; ++seed) {
    const RandomModel model = random_model(seed);
    INFO("seed " << seed);
    PieceCheck check(model.system);
    const RunSummary run = propagate(model.system,
                                     {.tolerance = 1e-12,
                                      .t_end = 300.0 / model.fastest,
                                      .energy_tolerance = 1e-9,
                                      .on_change = [&](const ContactChange& c) { check.note(c); }},
                                     {&check});
    INFO(run.brief_report());
    CHECK(run.ok());
    CHECK(std::abs(run.energy.relative_error()) < 1e-10);
    CHECK(check.worst_bound < 1e-11);
    CHECK(check.worst_end < 1e-10);
    changes += run.contact_changes;
    steps += check.steps;
  }
  // The models do what they are meant to.
  CHECK(changes > 10000);
  CHECK(steps > 10000);
}
