// The last part of SystemBuilder: elimination, terms and matrices over the unknowns.
#include <algorithm>
#include <cmath>
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

int slot_of(const SparseMatrix& pattern, int row, int col) {
  const int* begin = pattern.innerIndexPtr() + pattern.outerIndexPtr()[col];
  const int* end = pattern.innerIndexPtr() + pattern.outerIndexPtr()[col + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - pattern.innerIndexPtr());
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
  const int nodes = static_cast<int>(system_.node_names_.size());
  struct Tie {
    int to;
    double factor;
    std::size_t ratio;
  };
  std::vector<std::vector<Tie>> ties(at(nodes));
  for (std::size_t e = 0; e < described_.size(); ++e) {
    if (!described_[e]) continue;
    for (const LocalRow& b : described_[e]->terms.constraints) {
      Eigen::Index first = 0, second = b.size() - 1;  // the two entries that are not zero
      while (b[first] == 0.0) ++first;
      while (b[second] == 0.0) --second;
      const IdealRatio r{ElementId{static_cast<int>(e)},
                         described_[e]->nodes[static_cast<std::size_t>(first)],
                         described_[e]->nodes[static_cast<std::size_t>(second)], b[first],
                         b[second]};
      const std::size_t number = system_.ideal_ratios_.size();
      ties[at(r.first)].push_back({r.second, -r.b_first / r.b_second, number});
      ties[at(r.second)].push_back({r.first, -r.b_second / r.b_first, number});
      system_.ideal_ratios_.push_back(r);
    }
  }

  // Every set of nodes tied by ideal ratios has one unknown: that of its prescribed node, or its first.
  system_.node_map_.assign(at(nodes), {});
  std::vector<bool> placed(at(nodes), false);
  std::vector<bool> tie_used(system_.ideal_ratios_.size(), false);
  const auto spread = [&](int start, NodeMap map) {
    std::queue<int> queue;
    queue.push(start);
    placed[at(start)] = true;
    system_.node_map_[at(start)] = map;
    while (!queue.empty()) {
      const int i = queue.front();
      queue.pop();
      for (const auto& [to, factor, ratio] : ties[at(i)]) {
        if (placed[at(to)]) continue;
        placed[at(to)] = true;
        tie_used[ratio] = true;
        NodeMap next = system_.node_map_[at(i)];
        next.coeff *= factor;
        system_.node_map_[at(to)] = next;
        queue.push(to);
      }
    }
  };
  for (std::size_t i = 0; i < resolved_prescriptions_.size(); ++i) {
    const int node = resolved_prescriptions_[i];
    if (node < 0) continue;
    if (placed[at(node)]) {
      findings_.push_back({place(system_.node_names_[at(node)]), "prescribed motion", "", "",
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
    if (!placed[at(i)]) {
      system_.unknown_node_.push_back(i);
      spread(i, {.unknown = static_cast<int>(system_.unknown_node_.size()) - 1});
    }
  for (std::size_t r = 0; r < tie_used.size(); ++r)
    if (!tie_used[r])
      findings_.push_back({place(model_.placements()[at(index(system_.ideal_ratios_[r].element))].name),
                           "ideal gear", "", "",
                           "closes a loop of ideal gears: the torque in such a loop is "
                           "undetermined; make one of them elastic"});
}

void SystemBuilder::add_load(const LoadTerm& term) {
  const NodeMap& map = system_.node_map_[at(term.node)];
  const bool follows = term.load->depends_on_motion();
  system_.loads_depend_on_motion_ |= follows;
  if (map.unknown >= 0) {
    if (const auto table = term.load->table()) {
      system_.table_loads_.add(*table, map.unknown, map.coeff, system_.ratio(term.node),
                               follows ? map.coeff : 0.0);
    } else {
      (follows ? system_.moving_loads_ : system_.known_loads_)
          .push_back(static_cast<int>(system_.loads_.size()));
    }
  }
  system_.loads_.push_back(term);
}

void SystemBuilder::map_terms() {
  for (std::size_t e = 0; e < described_.size(); ++e) {
    const Described& d = *described_[e];
    const ElementId id{static_cast<int>(e)};
    for (const ScalarSpec& s : d.terms.scalars) {
      ScalarTerm term;
      term.element = id;
      term.force = s.force;
      term.phase_node = s.phase_node < 0 ? -1 : d.nodes[at(s.phase_node)];
      term.along_line_of_action = s.along_line_of_action;
      for (int i = 0; i < s.b.size(); ++i) {
        const NodeMap& map = system_.node_map_[at(d.nodes[at(i)])];
        if (s.b[i] != 0.0) term.nodes.push_back({d.nodes[at(i)], s.b[i]});
        if (map.unknown >= 0) add_entry(term.z, map.unknown, s.b[i] * map.coeff);
        if (map.prescribed >= 0) add_entry(term.u, map.prescribed, s.b[i] * map.coeff);
      }
      system_.scalars_.push_back(std::move(term));
    }
    for (const LoadSpec& l : d.terms.loads) add_load({id, d.nodes[at(l.node)], l.load, -1});
    for (const GeneralForce* g : d.terms.generals) {
      system_.generals_.push_back({id, g, d.nodes, system_.history_size_, {}});
      system_.history_size_ += g->history_size();
      system_.symmetric_tangent_ &= g->symmetric_tangent();
    }
    for (const OutputSpec& o : d.terms.outputs) {
      OutputTerm term{id, o.suffix, {}, {}};
      for (int i = 0; i < o.stiffness.size(); ++i)
        if (o.stiffness[i] != 0.0) term.stiffness.push_back({d.nodes[at(i)], o.stiffness[i]});
      for (int i = 0; i < o.damping.size(); ++i)
        if (o.damping[i] != 0.0) term.damping.push_back({d.nodes[at(i)], o.damping[i]});
      system_.outputs_.push_back(std::move(term));
    }
  }
}

void SystemBuilder::assemble_matrices() {
  const int nz = static_cast<int>(system_.unknown_node_.size());
  const int nu = static_cast<int>(system_.prescribed_.size());
  Triplets zz[3], zu[3], uu[3], node[3], clique;
  system_.nominal_inertia_ = Vector::Zero(nz + nu);
  system_.nominal_drag_ = Vector::Zero(nz + nu);
  const bool keep_nodes = !system_.ideal_ratios_.empty();
  if (keep_nodes)
    system_.node_drag_ = Vector::Zero(static_cast<Eigen::Index>(system_.node_names_.size()));

  const auto add_clique = [&](const std::vector<int>& dofs) {
    for (const int r : dofs)
      for (const int c : dofs) clique.emplace_back(r, c, 0.0);
  };
  const auto scatter = [&](int which, int i, int j, double value) {
    const NodeMap& a = system_.node_map_[at(i)];
    const NodeMap& b = system_.node_map_[at(j)];
    const double v = value * a.coeff * b.coeff;
    if (a.unknown >= 0 && b.unknown >= 0) zz[which].emplace_back(a.unknown, b.unknown, v);
    if (a.unknown >= 0 && b.prescribed >= 0) zu[which].emplace_back(a.unknown, b.prescribed, v);
    if (a.prescribed >= 0 && b.prescribed >= 0)
      uu[which].emplace_back(a.prescribed, b.prescribed, v);
    if (keep_nodes) node[which].emplace_back(i, j, value);
  };
  for (const auto& described : described_) {
    const Described& d = *described;
    const int n = static_cast<int>(d.nodes.size());
    const double a = d.terms.rayleigh ? rayleigh_a_ : 0.0;
    const double b = d.terms.rayleigh ? rayleigh_b_ : 0.0;
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) {
        const double m = d.terms.mass(i, j), c = d.terms.damping(i, j),
                     k = d.terms.stiffness(i, j);
        if (m != 0.0) scatter(0, d.nodes[at(i)], d.nodes[at(j)], m);
        if (c != 0.0) scatter(1, d.nodes[at(i)], d.nodes[at(j)], c);
        if (a * m + b * k != 0.0) scatter(1, d.nodes[at(i)], d.nodes[at(j)], a * m + b * k);
        if (k != 0.0) scatter(2, d.nodes[at(i)], d.nodes[at(j)], k);
        // Inertia and mean drag of the nominal motion; Rayleigh damping acts on deviations only.
        const NodeMap& map = system_.node_map_[at(d.nodes[at(i)])];
        const int row = map.unknown >= 0 ? map.unknown : nz + map.prescribed;
        const double ratio = system_.kinematics_.ratio[at(d.nodes[at(j)])];
        system_.nominal_inertia_[row] += map.coeff * m * ratio;
        system_.nominal_drag_[row] += map.coeff * c * ratio;
        if (keep_nodes) system_.node_drag_[d.nodes[at(i)]] += c * ratio;
      }
  }

  for (int k = 0; k < nz; ++k) clique.emplace_back(k, k, 0.0);
  for (const Triplets& t : zz)
    for (const auto& x : t) clique.emplace_back(x.row(), x.col(), 0.0);
  for (const ScalarTerm& s : system_.scalars_) {
    std::vector<int> dofs;
    for (const Entry& entry : s.z) dofs.push_back(entry.index);
    add_clique(dofs);
  }
  for (const GeneralTerm& g : system_.generals_) {
    std::vector<int> dofs;
    for (const int i : g.nodes)
      if (system_.node_map_[at(i)].unknown >= 0) dofs.push_back(system_.node_map_[at(i)].unknown);
    add_clique(dofs);
  }
  system_.pattern_ = from_triplets(nz, nz, clique);
  system_.pattern_.makeCompressed();
  const auto values = [&](const Triplets& triplets) {
    Vector v = Vector::Zero(system_.pattern_.nonZeros());
    for (const auto& x : triplets) v[slot_of(system_.pattern_, x.row(), x.col())] += x.value();
    return v;
  };
  system_.mass_ = values(zz[0]);
  system_.damping_ = values(zz[1]);
  system_.stiffness_ = values(zz[2]);
  for (int k = 0; k < nz; ++k) system_.diagonal_slots_.push_back(slot_of(system_.pattern_, k, k));
  const auto only_diagonal = [&](const Vector& matrix) {
    Vector rest = matrix;
    for (const int slot : system_.diagonal_slots_) rest[slot] = 0.0;
    return rest.isZero(0.0);
  };
  system_.mass_is_diagonal_ = only_diagonal(system_.mass_);
  system_.damping_is_diagonal_ = only_diagonal(system_.damping_);
  system_.zu_ = {from_triplets(nz, nu, zu[0]), from_triplets(nz, nu, zu[1]),
                 from_triplets(nz, nu, zu[2])};
  system_.uu_ = {from_triplets(nu, nu, uu[0]), from_triplets(nu, nu, uu[1]),
                 from_triplets(nu, nu, uu[2])};
  if (keep_nodes) {
    const int nodes = static_cast<int>(system_.node_names_.size());
    system_.node_matrices_ = MatrixSet{from_triplets(nodes, nodes, node[0]),
                                       from_triplets(nodes, nodes, node[1]),
                                       from_triplets(nodes, nodes, node[2])};
  }

  for (ScalarTerm& s : system_.scalars_)
    for (const Entry& r : s.z)
      for (const Entry& c : s.z) s.slots.push_back(slot_of(system_.pattern_, r.index, c.index));
  for (LoadTerm& l : system_.loads_) {
    const int k = system_.node_map_[at(l.node)].unknown;
    if (k >= 0) l.slot = slot_of(system_.pattern_, k, k);
  }
  for (GeneralTerm& g : system_.generals_)
    for (const int i : g.nodes)
      for (const int j : g.nodes) {
        const int r = system_.node_map_[at(i)].unknown, c = system_.node_map_[at(j)].unknown;
        g.slots.push_back(r >= 0 && c >= 0 ? slot_of(system_.pattern_, r, c) : -1);
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
    const double coeff = system_.node_map_[at(i)].coeff;
    if (!std::isfinite(coeff) || coeff == 0.0 || !std::isfinite(system_.ratio(i)))
      findings_.push_back({place(system_.node_names_[at(i)]), "ratio", to_text(coeff), "",
                           "the ratios of gears up to this node multiply to what a number cannot "
                           "hold"});
  }
}

}  // namespace drev
