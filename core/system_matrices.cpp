// The last part of SystemBuilder: elimination, terms and matrices over the unknowns.
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <numeric>
#include <queue>

#include "core/system_builder.hpp"

namespace drev {

namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

SparseMatrix from_triplets(int rows, int cols, const Triplets& triplets) {
  SparseMatrix m(rows, cols);
  m.setFromTriplets(triplets.begin(), triplets.end());
  return m;
}

void add_entry(std::vector<Entry>& row, int dof, double coeff) {
  for (Entry& e : row)
    if (e.index == dof) {
      e.coeff += coeff;
      return;
    }
  row.push_back({dof, coeff});
}

}  // namespace

void SystemBuilder::eliminate() {
  const int nodes = system_.node_count();
  struct Tie {
    int to;
    double factor;
    std::size_t ratio;
  };
  std::vector<std::vector<Tie>> ties(system_.ideal_ratios_.empty() ? 0 : idx(nodes));
  for (std::size_t number = 0; number < system_.ideal_ratios_.size(); ++number) {
    const IdealRatio& r = system_.ideal_ratios_[number];
    ties[idx(r.first)].push_back({r.second, -r.b_first / r.b_second, number});
    ties[idx(r.second)].push_back({r.first, -r.b_second / r.b_first, number});
  }

  // Every set of nodes tied by ideal ratios has one unknown: that of its prescribed node, or its first.
  system_.node_map_.assign(idx(nodes), {});
  std::vector<bool> placed(idx(nodes), false);
  std::vector<bool> tie_used(system_.ideal_ratios_.size(), false);
  const auto spread = [&](int start, NodeMap map) {
    std::queue<int> queue;
    queue.push(start);
    placed[idx(start)] = true;
    system_.node_map_[idx(start)] = map;
    while (!queue.empty()) {
      const int i = queue.front();
      queue.pop();
      if (ties.empty()) continue;
      for (const auto& [to, factor, ratio] : ties[idx(i)]) {
        if (placed[idx(to)]) continue;
        placed[idx(to)] = true;
        tie_used[ratio] = true;
        NodeMap next = system_.node_map_[idx(i)];
        next.coeff *= factor;
        system_.node_map_[idx(to)] = next;
        queue.push(to);
      }
    }
  };
  for (std::size_t i = 0; i < resolved_prescriptions_.size(); ++i) {
    const int node = resolved_prescriptions_[i];
    if (node < 0) continue;
    if (placed[idx(node)]) {
      findings_.push_back({place(node_name(node)), "prescribed motion", "", "",
                           "a node tied to this one by ideal gears is prescribed already"});
      continue;
    }
    const int k = static_cast<int>(system_.prescribed_.size());
    const auto& deviation = model_.prescriptions()[i].deviation;
    system_.prescribed_.push_back(deviation ? *deviation : Motion{});
    system_.any_prescribed_moves_ |= deviation.has_value();
    system_.prescribed_node_.push_back(node);
    spread(node, {.unknown = -1, .prescribed = k, .coeff = 1.0});
  }
  for (int i = 0; i < nodes; ++i)
    if (!placed[idx(i)]) {
      system_.unknown_node_.push_back(i);
      spread(i, {.unknown = static_cast<int>(system_.unknown_node_.size()) - 1});
    }
  for (std::size_t r = 0; r < tie_used.size(); ++r)
    if (!tie_used[r])
      findings_.push_back(
          {place(model_.element_instances()[idx(index(system_.ideal_ratios_[r].element))].name), "ideal gear",
           "", "",
           "closes a loop of ideal gears: the torque in such a loop is "
           "undetermined; make one of them elastic"});
}

void SystemBuilder::map_terms() {
  for (FrequencyTerm& term : system_.frequency_terms_)
    for (const Entry& e : term.nodes)
      if (const NodeMap& map = system_.node_map_[idx(e.index)]; map.unknown >= 0)
        add_entry(term.z, map.unknown, e.coeff * map.coeff);
  for (ScalarTerm& term : system_.scalars_)
    for (const Entry& e : term.nodes) {
      const NodeMap& map = system_.node_map_[idx(e.index)];
      if (map.unknown >= 0) add_entry(term.z, map.unknown, e.coeff * map.coeff);
      if (map.prescribed >= 0) add_entry(term.u, map.prescribed, e.coeff * map.coeff);
    }
  for (int i = 0; i < static_cast<int>(system_.loads_.size()); ++i) system_.map_load(i);
}

template <class Visit>
void SystemBuilder::for_each_entry(int matrix, const Visit& visit) const {
  if (matrix == 1) {
    damping_.for_each(1.0, visit);
    deviation_damping_.for_each(1.0, visit);
    mass_[1].for_each(rayleigh_a_, visit);
    stiffness_[1].for_each(rayleigh_b_, visit);
  } else {
    for (const NodeMatrix& part : matrix == 0 ? mass_ : stiffness_) part.for_each(1.0, visit);
  }
}

template <class Visit>
void SystemBuilder::for_each_coupling(const Visit& visit) const {
  const auto couple = [&](int i, int j) {
    const int row = system_.node_map_[idx(i)].unknown, column = system_.node_map_[idx(j)].unknown;
    if (row >= 0 && column >= 0 && row != column) visit(row, column);
  };
  for (int matrix = 0; matrix < 3; ++matrix)
    for_each_entry(matrix, [&](int i, int j, double) { couple(i, j); });
  const auto all = [&](const auto& terms) {
    for (const auto& term : terms)
      for (const Entry& a : term.nodes)
        for (const Entry& b : term.nodes) couple(a.index, b.index);
  };
  all(system_.scalars_);
  all(system_.frequency_terms_);
  for (const GeneralTerm& g : system_.generals_)
    for (const int i : g.nodes)
      for (const int j : g.nodes) couple(i, j);
}

SystemBuilder::Couplings SystemBuilder::couplings() const {
  const auto n = system_.unknown_node_.size();
  Couplings c{std::vector<int>(n + 1, 1), {}};  // each with itself
  c.begin[0] = 0;
  for_each_coupling([&](int, int column) { ++c.begin[idx(column + 1)]; });
  std::partial_sum(c.begin.begin(), c.begin.end(), c.begin.begin());
  c.others.resize(idx(c.begin.back()));
  std::vector<int> next(c.begin.begin(), c.begin.end() - 1);
  for (std::size_t k = 0; k < n; ++k) c.others[idx(next[k]++)] = static_cast<int>(k);
  for_each_coupling([&](int row, int column) { c.others[idx(next[idx(column)]++)] = row; });
  auto to = c.others.begin();
  for (std::size_t k = 0; k < n; ++k) {
    const auto first = c.others.begin() + c.begin[k], last = c.others.begin() + c.begin[k + 1];
    std::sort(first, last);
    c.begin[k] = static_cast<int>(to - c.others.begin());
    to = std::copy(first, std::unique(first, last), to);
  }
  c.begin[n] = static_cast<int>(to - c.others.begin());
  c.others.erase(to, c.others.end());
  return c;
}

void SystemBuilder::order_unknowns() {
  bool in_order = true;
  for_each_coupling([&](int i, int j) { in_order &= std::abs(i - j) == 1; });
  if (in_order) return;
  const Couplings c = couplings();
  const auto n = system_.unknown_node_.size();
  std::vector<int> order, number(n, -1);
  // From each end along neighbours, next ones by their numbers first; then what is left, which lies in loops.
  const auto walk = [&](int at) {
    const auto start = static_cast<std::ptrdiff_t>(order.size());
    int rises = 0;
    for (;;) {
      number[idx(at)] = 0;
      order.push_back(at);
      int next = -1;
      for (int i = c.begin[idx(at)]; i < c.begin[idx(at + 1)]; ++i)
        if (const int other = c.others[idx(i)];
            number[idx(other)] < 0 && (next < 0 || std::abs(other - at) < std::abs(next - at)))
          next = other;
      if (next < 0) break;
      rises += next > at ? 1 : -1;
      at = next;
    }
    if (rises < 0) std::reverse(order.begin() + start, order.end());
  };
  for (const bool ends : {true, false})
    for (std::size_t k = 0; k < n; ++k)
      if (number[k] < 0 && (!ends || c.begin[k + 1] - c.begin[k] <= 2)) walk(static_cast<int>(k));
  for (std::size_t i = 0; i < n; ++i) number[idx(order[i])] = static_cast<int>(i);
  std::ptrdiff_t fewer = 0;
  for (int k = 0; k < static_cast<int>(n); ++k)
    for (int i = c.begin[idx(k)]; i < c.begin[idx(k + 1)]; ++i) {
      const int other = c.others[idx(i)];
      fewer +=
          (std::abs(other - k) > 1 ? 1 : 0) - (std::abs(number[idx(other)] - number[idx(k)]) > 1 ? 1 : 0);
    }
  if (fewer <= 0) return;
  for (NodeMap& map : system_.node_map_)
    if (map.unknown >= 0) map.unknown = number[idx(map.unknown)];
  for (int& k : order) k = system_.unknown_node_[idx(k)];
  system_.unknown_node_ = std::move(order);
}

std::shared_ptr<const SparseMatrix> SystemBuilder::pattern() const {
  const Couplings c = couplings();
  const auto n = static_cast<int>(system_.unknown_node_.size()), entries = c.begin.back();
  const auto p = std::make_shared<SparseMatrix>(n, n);
  std::copy(c.begin.begin(), c.begin.end(), p->outerIndexPtr());
  p->resizeNonZeros(entries);
  std::copy_n(c.others.begin(), entries, p->innerIndexPtr());
  std::fill_n(p->valuePtr(), entries, 0.0);
  return p;
}

Vector SystemBuilder::values_on_pattern(int matrix) const {
  Vector v = Vector::Zero(system_.pattern_->nonZeros());
  for_each_entry(matrix, [&](int i, int j, double value) {
    const NodeMap &a = system_.node_map_[idx(i)], &b = system_.node_map_[idx(j)];
    if (a.unknown >= 0 && b.unknown >= 0) v[system_.slot(a.unknown, b.unknown)] += value * a.coeff * b.coeff;
  });
  return v;
}

void SystemBuilder::start_internal_nodes(const std::vector<int>& set_by) {
  std::vector<int> row(system_.unknown_node_.size(), -1), open;  // of unknowns that nothing states; those
  for (const ElementInstance& element : model_.element_instances())
    for (const NodeId id : element.internal)
      if (const int k = system_.node_map_[idx(index(id))].unknown; k >= 0 && set_by[idx(k)] < 0) {
        row[idx(k)] = static_cast<int>(open.size());
        open.push_back(k);
      }
  if (open.empty()) return;
  const int rows = static_cast<int>(open.size());
  Triplets triplets;
  Vector diagonal = Vector::Zero(rows), by_damping = Vector::Zero(rows);
  Eigen::MatrixXd known = Eigen::MatrixXd::Zero(rows, 2);  // -K_ik q_k and -K_ik q_k' of the known nodes k
  const auto enter = [&](int r, int j, double value, bool deviation) {
    const NodeMap& map = system_.node_map_[idx(j)];
    MotionPoint q;
    if (map.unknown >= 0)
      q = {system_.initial_z_[map.unknown], system_.initial_v_[map.unknown]};
    else if (const Motion& motion = system_.prescribed_[idx(map.prescribed)]; motion.at)
      q = motion.at(0.0);
    if (deviation) known(r, 0) -= value * map.coeff * q.value;
    known(r, 1) -= value * map.coeff * q.rate;
  };
  const auto each_row = [&](int matrix, const auto& visit) {
    for_each_entry(matrix, [&](int i, int j, double value) {
      const NodeMap &a = system_.node_map_[idx(i)], &b = system_.node_map_[idx(j)];
      if (a.unknown >= 0 && row[idx(a.unknown)] >= 0)
        visit(row[idx(a.unknown)], b.unknown >= 0 ? row[idx(b.unknown)] : -1, j, a.coeff * value, b.coeff);
    });
  };
  each_row(2, [&](int r, int c, int j, double value, double coeff) {
    if (c < 0) return enter(r, j, value, true);
    triplets.emplace_back(r, c, value * coeff);
    if (r == c) diagonal[r] += value * coeff;
  });
  // What a damper alone moves along (a ring in oil) takes the rate at which the damper exerts nothing.
  each_row(1, [&](int r, int c, int j, double value, double coeff) {
    if (diagonal[r] != 0.0) return;
    if (c < 0) return enter(r, j, value, false);
    if (r == c) by_damping[r] += value * coeff;
  });
  for (int r = 0; r < rows; ++r)
    if (diagonal[r] == 0.0) triplets.emplace_back(r, r, by_damping[r] > 0.0 ? by_damping[r] : 1.0);
  const Eigen::SimplicialLDLT<SparseMatrix> factor(from_triplets(rows, rows, triplets));
  if (factor.info() != Eigen::Success) return;
  const Eigen::MatrixXd start = factor.solve(known);
  if (!start.allFinite()) return;
  // Nodes whose speed no other's gives (a governor's actuator) start at rest.
  std::vector<int> nodes_in(component_.size(), 0);
  for (const int c : component_) ++nodes_in[idx(c)];
  for (int r = 0; r < rows; ++r) {
    const int k = open[idx(r)];
    system_.initial_z_[k] = start(r, 0);
    if (nodes_in[idx(component_[idx(system_.unknown_node_[idx(k)])])] > 1)
      system_.initial_v_[k] = start(r, 1);
  }
}

void SystemBuilder::assemble_matrices() {
  const int nz = static_cast<int>(system_.unknown_node_.size());
  const int nu = static_cast<int>(system_.prescribed_.size());
  Triplets zu[3], uu[3], node[3];
  const bool keep_nodes = !system_.ideal_ratios_.empty();
  for (int which = 0; which < 3; ++which)
    for_each_entry(which, [&](int i, int j, double value) {
      const NodeMap &a = system_.node_map_[idx(i)], &b = system_.node_map_[idx(j)];
      const double v = value * a.coeff * b.coeff;
      if (a.unknown >= 0 && b.prescribed >= 0) zu[which].emplace_back(a.unknown, b.prescribed, v);
      if (a.prescribed >= 0 && b.prescribed >= 0) uu[which].emplace_back(a.prescribed, b.prescribed, v);
      if (keep_nodes) node[which].emplace_back(i, j, value);
    });
  // Inertia and mean drag of the nominal motion; Rayleigh damping acts on deviations only.
  system_.nominal_inertia_ = Vector::Zero(nz + nu);
  system_.nominal_drag_ = Vector::Zero(nz + nu);
  if (keep_nodes) system_.node_drag_ = Vector::Zero(system_.node_count());
  const auto add_nominal = [&](const NodeMatrix& matrix, Vector& rows, Vector* nodes) {
    matrix.for_each(1.0, [&](int i, int j, double value) {
      const NodeMap& map = system_.node_map_[idx(i)];
      const double force = value * system_.ratio(j);
      rows[map.unknown >= 0 ? map.unknown : nz + map.prescribed] += map.coeff * force;
      if (nodes) (*nodes)[i] += force;
    });
  };
  for (const NodeMatrix& mass : mass_) add_nominal(mass, system_.nominal_inertia_, nullptr);
  add_nominal(damping_, system_.nominal_drag_, keep_nodes ? &system_.node_drag_ : nullptr);

  system_.pattern_ = pattern();
  // Entries go as soon as their values stand: a large model's memory is at its highest here.
  system_.damping_ = values_on_pattern(1);
  damping_.clear();
  deviation_damping_.clear();
  system_.stiffness_ = values_on_pattern(2);
  for (NodeMatrix& part : stiffness_) part.clear();
  system_.mass_ = values_on_pattern(0);
  for (NodeMatrix& part : mass_) part.clear();
  system_.find_slots();
  system_.zu_ = {from_triplets(nz, nu, zu[0]), from_triplets(nz, nu, zu[1]), from_triplets(nz, nu, zu[2])};
  system_.uu_ = {from_triplets(nu, nu, uu[0]), from_triplets(nu, nu, uu[1]), from_triplets(nu, nu, uu[2])};
  if (keep_nodes) {
    const int nodes = system_.node_count();
    system_.node_matrices_ =
        MatrixSet{from_triplets(nodes, nodes, node[0]), from_triplets(nodes, nodes, node[1]),
                  from_triplets(nodes, nodes, node[2])};
  }
}

void SystemBuilder::check_values() {
  const auto finite = [this](const char* what, const Vector& values) {
    if (!values.allFinite())
      findings_.push_back({model_.name(), what, "infinite", "",
                           "the sum over the model exceeds what a number can hold; check the ideal "
                           "gears' ratios and the largest parameters"});
  };
  finite("mass matrix", system_.mass_);
  finite("damping matrix", system_.damping_);
  finite("stiffness matrix", system_.stiffness_);
  for (int i = 0; i < system_.node_count(); ++i) {
    const double coeff = system_.node_map_[idx(i)].coeff;
    if (!std::isfinite(coeff) || coeff == 0.0 || !std::isfinite(system_.ratio(i)))
      findings_.push_back({place(node_name(i)), "ratio", to_text(coeff), "",
                           "the ratios of gears up to this node multiply to what a number cannot "
                           "hold"});
  }
}

}  // namespace drev
