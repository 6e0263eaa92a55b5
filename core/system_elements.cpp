// The first part of SystemBuilder: the elements, each by itself.
#include <algorithm>

#include "core/system_builder.hpp"

namespace drev {

std::vector<int> SystemBuilder::resolve_nodes(const Placement& p, bool& usable) {
  const std::string where = place(p.name);
  std::vector<int> nodes;
  for (std::size_t i = 0; i < p.nodes.size(); ++i) {
    nodes.push_back(resolve(p.nodes[i], where, "node " + std::to_string(i + 1)));
    usable = usable && nodes.back() >= 0;
    if (nodes.back() >= 0 && std::count(nodes.begin(), nodes.end(), nodes.back()) > 1) {
      findings_.push_back({where, "node " + std::to_string(i + 1),
                           system_.node_names_[at(nodes.back())], "",
                           "is given twice; the ends must differ"});
      usable = false;
    }
  }
  for (const NodeId id : p.internal) nodes.push_back(index(id));
  return nodes;
}

void SystemBuilder::describe_elements() {
  for (const Placement& p : model_.placements()) {
    const std::string where = place(p.name);
    bool usable = true;
    const std::vector<int> nodes = resolve_nodes(p, usable);
    const bool resolved = std::count(nodes.begin(), nodes.end(), -1) == 0;
    element_nodes_.push_back(nodes);
    described_.emplace_back();
    if (!p.element) {
      findings_.push_back({where, "element", "", "", "is missing (a null pointer)"});
      inertia_in_doubt_ |= !resolved;
      continue;
    }
    const int given = static_cast<int>(p.nodes.size());
    const int low = p.element->min_nodes(), high = p.element->max_nodes();
    const bool count_fits = given >= low && given <= high;
    if (!count_fits)
      findings_.push_back({where, "nodes", std::to_string(given), "",
                           "a " + std::string(p.element->type()) + " takes " +
                               std::to_string(low) +
                               (high > low ? " or " + std::to_string(high) : std::string())});
    const std::size_t before = findings_.size();
    ParameterCheck check(where, findings_);
    p.element->check(check);
    const bool sound = count_fits && findings_.size() == before;
    if (!sound) {
      inertia_in_doubt_ |= !resolved;
      continue;
    }
    Terms terms(static_cast<int>(nodes.size()));
    p.element->describe(static_cast<int>(nodes.size()), terms);
    if (!check_terms(terms, nodes, where)) {
      inertia_in_doubt_ |= !resolved;
      continue;
    }
    if (!resolved) inertia_in_doubt_ |= !terms.mass.isZero(0.0) || !terms.constraints.empty();
    if (usable && check_kinds(p, nodes)) described_.back() = Described{nodes, std::move(terms)};
  }
}

bool SystemBuilder::check_terms(const Terms& terms, const std::vector<int>& nodes,
                                const std::string& where) {
  const std::size_t before = findings_.size();
  const auto n = static_cast<Eigen::Index>(nodes.size());
  const auto fail = [&](const std::string& what, std::string value, std::string range) {
    findings_.push_back({where, "describe(): " + what, std::move(value), "", std::move(range)});
  };
  const auto matrix = [&](const char* name, const Eigen::MatrixXd& m) {
    if (m.rows() != n || m.cols() != n)
      fail(name, std::to_string(m.rows()) + " x " + std::to_string(m.cols()),
           "must be n x n for n = " + std::to_string(n) + " nodes");
    else if (!m.allFinite())
      fail(name, "not finite", "must be finite");
    else if (!m.isApprox(m.transpose(), 1e-12) && !m.isZero(0.0))
      fail(name, "not symmetric", "must be symmetric; a general force may be otherwise");
  };
  // Number of entries that are not zero; -1 after a finding.
  const auto row = [&](const char* name, const LocalRow& b, bool may_be_empty) {
    if (may_be_empty && b.size() == 0) return 0;
    if (b.size() != n)
      fail(name, std::to_string(b.size()) + " entries", "must have one for each of " +
                                                           std::to_string(n) + " nodes");
    else if (!b.allFinite())
      fail(name, "not finite", "must be finite");
    else
      return static_cast<int>((b.array() != 0.0).count());
    return -1;
  };
  matrix("mass", terms.mass);
  matrix("damping", terms.damping);
  matrix("stiffness", terms.stiffness);
  for (const ScalarSpec& s : terms.scalars) {
    const int entries = row("scalar b", s.b, false);
    if (entries == 0) fail("scalar b", "0", "must have an entry that is not 0");
    if (!s.force) fail("scalar force", "", "is missing (a null pointer)");
    if (s.phase_node < -1 || s.phase_node >= n)
      fail("phase_node", std::to_string(s.phase_node), "is no node of the element");
    if (entries > 0 && s.along_line_of_action)
      for (Eigen::Index i = 0; i < n; ++i) {
        const int node = nodes[static_cast<std::size_t>(i)];
        if (s.b[i] != 0.0 && node >= 0 && system_.node_kinds_[at(node)] != NodeKind::rotational)
          findings_.push_back({where, "node " + std::to_string(i + 1), system_.node_names_[at(node)],
                               "", "is translational; a gear needs a rotational node"});
      }
  }
  for (const LoadSpec& l : terms.loads) {
    if (l.node < 0 || l.node >= n)
      fail("load node", std::to_string(l.node), "is no node of the element");
    if (!l.load)
      fail("load", "", "is missing (a null pointer)");
    else
      ParameterCheck(where, findings_).all_finite("breakpoints", l.load->breakpoints(), "s");
  }
  for (const GeneralForce* g : terms.generals) {
    if (!g) fail("general force", "", "is missing (a null pointer)");
    if (g && g->history_size() < 0)
      fail("history_size", std::to_string(g->history_size()), "must be >= 0");
    if (n > kMaxLocalDofs)
      fail("general force", std::to_string(n) + " nodes",
           "must have at most " + std::to_string(kMaxLocalDofs));
  }
  for (const ClosureSpec& c : terms.closures)
    if (row("closure", c.b, false) > 2) fail("closure", "", "may tie at most two nodes");
  for (const LocalRow& b : terms.constraints) {
    const int entries = row("constraint", b, false);
    if (entries >= 0 && entries != 2)
      fail("constraint", std::to_string(entries) + " nodes", "must tie exactly two");
  }
  for (const OutputSpec& o : terms.outputs) {
    row("output stiffness", o.stiffness, true);
    row("output damping", o.damping, true);
  }
  ParameterCheck check(where, findings_);
  check.non_negative("describe(): rayleigh_a", terms.rayleigh_a, "1/s");
  check.non_negative("describe(): rayleigh_b", terms.rayleigh_b, "s");
  return findings_.size() == before;
}

bool SystemBuilder::check_kinds(const Placement& p, const std::vector<int>& nodes) {
  if (p.element->mixes_kinds()) return true;
  for (const int node : nodes) {
    const NodeKind first = system_.node_kinds_[at(nodes.front())];
    if (system_.node_kinds_[at(node)] == first) continue;
    const bool turns = first == NodeKind::rotational;
    findings_.push_back({place(p.name), "node", system_.node_names_[at(node)], "",
                         std::string("is ") + (turns ? "translational" : "rotational") + " and " +
                             system_.node_names_[at(nodes.front())] + " is " +
                             (turns ? "rotational" : "translational") + "; a " +
                             std::string(p.element->type()) + " joins nodes of one kind"});
    return false;
  }
  return true;
}

}  // namespace drev
