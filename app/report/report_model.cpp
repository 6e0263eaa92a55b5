#include "app/report/report_model.hpp"

#include <drev/core/element.hpp>
#include <drev/core/general_force.hpp>
#include <drev/core/law/friction.hpp>
#include <drev/core/scalar_force.hpp>

#include <algorithm>
#include <cmath>

#include "core/dense/factorization.hpp"
#include "core/element_parts.hpp"

namespace drev::app {

namespace {

constexpr double kSumRounding = 1e-9;  // relative rounding of sums that should be zero [-]
constexpr std::size_t kSharesShown = 3;
constexpr double kShareShown = 0.005;

std::vector<int> nodes_of(const ElementInstance& placement, const System& system) {
  std::vector<int> nodes;
  for (const NodeRef& node : placement.nodes) nodes.push_back(system.node_of(node));
  for (const NodeId node : placement.internal) nodes.push_back(static_cast<int>(node));
  return nodes;
}

/// Adds one element to the drawing.
class Drawing {
 public:
  explicit Drawing(const System& system) : inertia_(static_cast<std::size_t>(system.node_count())) {}

  void add(const ElementInstance& placement, const std::vector<int>& nodes) {
    placement_ = &placement;
    parts_.for_each(*placement.element, nodes, [this](const Terms& terms, const std::vector<int>& of_part) {
      add_part(terms, of_part);
    });
  }

  double inertia(int node) const { return inertia_[static_cast<std::size_t>(node)]; }
  Json joints = Json::array(), loads = Json::array();

 private:
  void add_part(const Terms& terms, const std::vector<int>& nodes) {
    nodes_ = &nodes;
    const int n = static_cast<int>(nodes.size());
    for (int i = 0; i < n; ++i) inertia_[place(i)] += terms.mass.row(i).sum();
    if (!add_along_deflection(terms)) add_matrix(terms.stiffness, "shaft", "stiffness", &terms.damping);
    if (terms.stiffness.isZero(0.0)) add_matrix(terms.damping, "damper", "damping");
    for (const ScalarSpec& spec : terms.scalars) add_law(spec);
    for (const LocalRow& row : terms.constraints) add_gear(row);
    for (const FrictionSpec& spec : terms.frictions) add_friction(spec);
    for (const GeneralForce* general : terms.generals)
      if (general != nullptr) add_other();
    for (const LoadSpec& load : terms.loads)
      loads.push_back({{"name", placement_->name}, {"type", type()}, {"node", node(load.node)}});
  }
  std::string type() const { return std::string(placement_->element->type()); }
  int node(int local) const { return (*nodes_)[static_cast<std::size_t>(local)]; }
  std::size_t place(int local) const { return static_cast<std::size_t>(node(local)); }

  Json& joint(const char* kind, std::vector<int> local) {
    Json list = Json::array();
    for (const int i : local) list.push_back(node(i));
    joints.push_back(
        {{"name", placement_->name}, {"type", type()}, {"kind", kind}, {"nodes", std::move(list)}});
    return joints.back();
  }

  /// Adds a spring with internal nodes (a viscoelastic element) that gives its deflection: one shaft of its
  /// static stiffness.
  bool add_along_deflection(const Terms& terms) {
    if (terms.outputs.size() != 1 || terms.outputs[0].deflection.size() == 0) return false;
    std::vector<int> ends, inner;
    for (int i = 0; i < static_cast<int>(terms.stiffness.rows()); ++i)
      (terms.outputs[0].deflection[i] != 0.0 ? ends : inner).push_back(i);
    if (ends.size() != 2 || inner.empty() || terms.stiffness.isZero(0.0)) return false;
    const Eigen::MatrixXd within = terms.stiffness(inner, inner);
    const Eigen::VectorXd across = terms.stiffness(inner, ends)(Eigen::all, 1);
    Json& found = joint("shaft", ends);
    found["stiffness"] = terms.stiffness(ends[1], ends[1]) - across.dot(ldlt_solve(within, across));
    if (const double c = -terms.damping(ends[0], ends[1]); c != 0.0) found["damping"] = c;
    return true;
  }

  /// damping: damping of a shaft in addition to its stiffness.
  void add_matrix(const Eigen::MatrixXd& k, const char* kind, const char* value,
                  const Eigen::MatrixXd* damping = nullptr) {
    for (Eigen::Index i = 0; i < k.rows(); ++i) {
      for (Eigen::Index j = 0; j < i; ++j)
        if (k(i, j) != 0.0) {
          Json& found = joint(kind, {static_cast<int>(j), static_cast<int>(i)});
          found[value] = -k(i, j);
          if (damping != nullptr && (*damping)(i, j) != 0.0) found["damping"] = -(*damping)(i, j);
        }
      const double to_ground = k.row(i).sum();
      if (std::abs(to_ground) > kSumRounding * std::abs(k(i, i)))
        joint(kind, {static_cast<int>(i)})[value] = to_ground;
    }
  }

  void add_law(const ScalarSpec& spec) {
    const std::vector<int> local = nodes_in(spec.b);
    const bool mesh = spec.along_line_of_action && local.size() > 1;
    if (local.empty() || (local.size() > 2 && !mesh)) return add_star(spec.b);
    Json& law = joint(mesh ? "mesh" : "spring", mesh ? std::vector<int>{local[0], local[1]} : local);
    law["stiffness"] = number(spec.force->closed_stiffness());
    if (const double c = spec.force->closed_damping(); c != 0.0) law["damping"] = c;
    if (const auto gap = spec.force->gap()) law["gap"] = gap->high - gap->low;
    if (!mesh) return;
    const bool internal = spec.b[local[0]] * spec.b[local[1]] < 0.0;
    law["radii"] = {std::abs(spec.b[local[0]]), std::abs(spec.b[local[1]])};
    law["internal"] = internal;
    if (local.size() == 2) return;
    // The nodes after the gears are their carrier (a planet is the second gear of the sun's mesh, the first
    // of the ring's), or the centre of each gear.
    law["carried"] = local.size() == 3;
    if (local.size() == 3) joint("other", {local[internal ? 0 : 1], local[2]});
    for (std::size_t i = 2; local.size() > 3 && i < local.size(); ++i)
      joint("other", {local[i - 2], local[i]});
  }

  void add_gear(const LocalRow& row) {
    const std::vector<int> local = nodes_in(row);
    if (local.size() != 2) return add_star(row);
    joint("gear", local)["ratio"] = -row[local[0]] / row[local[1]];
  }

  /// A lossy gear is drawn by its tie.
  void add_friction(const FrictionSpec& spec) {
    if (spec.friction->gear_loss()) return;
    if (spec.friction->rigid()) return add_gear(spec.b);
    const std::vector<int> local = nodes_in(spec.b);
    if (local.size() > 2) return add_star(spec.b);
    joint("friction", local)["one_way"] = spec.friction->one_way();
  }

  static std::vector<int> nodes_in(const LocalRow& row) {
    std::vector<int> local;
    for (int i = 0; i < static_cast<int>(row.size()); ++i)
      if (row[i] != 0.0) local.push_back(i);
    return local;
  }

  /// More than two nodes: each is joined to the one with the largest coefficient, the carrier of a planetary
  /// gear set.
  void add_star(const LocalRow& row) {
    const std::vector<int> local = nodes_in(row);
    if (local.empty()) return add_other();
    const int centre = *std::max_element(local.begin(), local.end(),
                                         [&](int a, int b) { return std::abs(row[a]) < std::abs(row[b]); });
    for (const int i : local)
      if (i != centre) joint("other", {i, centre});
  }

  void add_other() {
    if (nodes_->size() < 2) joint("other", {0});
    for (int i = 1; i < static_cast<int>(nodes_->size()); ++i) joint("other", {i - 1, i});
  }

  const ElementInstance* placement_ = nullptr;
  const std::vector<int>* nodes_ = nullptr;
  std::vector<double> inertia_;
  ElementParts parts_;
};

/// q'Kq of a part of an element, with its laws closed, for the shape of a mode over all nodes.
double potential(const Terms& terms, const std::vector<int>& nodes, const Eigen::VectorXd& shape) {
  const Eigen::VectorXd q = shape(nodes);
  double energy = q.dot(terms.stiffness * q);
  for (const ScalarSpec& spec : terms.scalars)
    energy += spec.force->closed_stiffness() * std::pow(spec.b.dot(q), 2);
  return energy;
}

}  // namespace

Json model_object(const Model& model, const System& system) {
  Drawing drawing(system);
  for (const ElementInstance& placement : model.element_instances())
    drawing.add(placement, nodes_of(placement, system));
  Json nodes = Json::array();
  for (int i = 0; i < system.node_count(); ++i) {
    const int prescribed = system.node_map(i).prescribed;
    nodes.push_back({{"name", system.node_names()[static_cast<std::size_t>(i)]},
                     {"turns", system.node_kind(i) == NodeKind::rotational},
                     {"ratio", number(system.ratio(i))},
                     {"inertia", number(drawing.inertia(i))},
                     {"held", prescribed >= 0 && system.prescribed_node(prescribed) == i}});
  }
  return {{"nodes", std::move(nodes)},
          {"joints", std::move(drawing.joints)},
          {"loads", std::move(drawing.loads)},
          {"unknowns", system.size()}};
}

Json modes_object(const System& system, const ModeSet& modes) {
  std::vector<std::vector<int>> nodes;
  for (const ElementInstance& placement : system.element_instances())
    nodes.push_back(nodes_of(placement, system));
  Json list = Json::array();
  ElementParts parts;
  for (int m = 0; m < modes.count(); ++m) {
    const Eigen::VectorXd shape = modes.shapes.col(m);
    std::vector<std::pair<double, std::string>> shares;
    double sum = 0.0;
    for (std::size_t e = 0; e < nodes.size(); ++e) {
      const ElementInstance& placement = system.element_instances()[e];
      double energy = 0.0;
      parts.for_each(*placement.element, nodes[e], [&](const Terms& terms, const std::vector<int>& of_part) {
        energy += potential(terms, of_part, shape);
      });
      sum += energy;
      shares.emplace_back(energy, placement.name);
    }
    std::stable_sort(shares.begin(), shares.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    Json energy = Json::array();
    for (std::size_t e = 0; e < std::min(kSharesShown, shares.size()); ++e)
      if (shares[e].first > kShareShown * sum)
        energy.push_back({{"element", shares[e].second}, {"share", number(shares[e].first / sum)}});
    const double largest = shape.cwiseAbs().maxCoeff();
    Json values = Json::array();
    for (Eigen::Index i = 0; i < shape.size(); ++i)
      values.push_back(std::round(1e5 * shape[i] / (largest > 0.0 ? largest : 1.0)) / 1e5);
    list.push_back({{"frequency_Hz", modes.frequency_Hz[static_cast<std::size_t>(m)]},
                    {"shape", std::move(values)},
                    {"energy", std::move(energy)}});
  }
  return list;
}

}  // namespace drev::app
