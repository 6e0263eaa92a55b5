// The first part of SystemBuilder: the elements, each by itself. And what they report.
#include <drev/core/general_force.hpp>
#include <drev/core/law/friction.hpp>

#include <algorithm>
#include <iterator>

#include "core/contradictions.hpp"
#include "core/element_parts.hpp"
#include "core/names/article.hpp"
#include "core/system_builder.hpp"

namespace drev {

namespace {

std::vector<Entry> over_nodes(const LocalRow& row, const std::vector<int>& nodes) {
  std::vector<Entry> entries;
  for (Eigen::Index i = 0; i < row.size(); ++i)
    if (row[i] != 0.0) entries.push_back({nodes[static_cast<std::size_t>(i)], row[i]});
  return entries;
}

}  // namespace

std::vector<int> SystemBuilder::resolve_nodes(const ElementInstance& p, bool& usable) {
  std::vector<int> nodes;
  for (int i = 0; i < p.nodes.size(); ++i) {
    const NodeRef ref = p.nodes[i];
    const int node = find(ref);
    const bool twice = node >= 0 && std::count(nodes.begin(), nodes.end(), node) > 0;
    nodes.push_back(node);
    if (node >= 0 && !twice) continue;
    usable = false;
    const std::string parameter = "node " + std::to_string(i + 1);
    if (twice)
      findings_.push_back(
          {place(p.name), parameter, node_name(node), "", "is given twice; the ends must differ"});
    else
      resolve(ref, place(p.name), parameter);
  }
  for (const NodeId id : p.internal) nodes.push_back(index(id));
  return nodes;
}

void SystemBuilder::describe_elements() {
  ElementParts parts;
  for (int e = 0; e < static_cast<int>(model_.element_instances().size()); ++e) {
    const ElementInstance& p = model_.element_instances()[idx(e)];
    bool usable = true;
    const std::vector<int> nodes = resolve_nodes(p, usable);
    const bool resolved = std::count(nodes.begin(), nodes.end(), -1) == 0;
    const auto faulty = [&] {
      std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(faulty_nodes_),
                   [](int node) { return node >= 0; });
    };
    if (!p.element) {
      findings_.push_back({place(p.name), "element", "", "", "is missing (a null pointer)"});
      inertia_in_doubt_ |= !resolved;
      faulty();
      continue;
    }
    const int given = p.nodes.size();
    const int low = p.element->min_nodes(), high = p.element->max_nodes();
    const bool count_fits = given >= low && given <= high;
    if (!count_fits)
      findings_.push_back({place(p.name), "nodes", std::to_string(given), "",
                           with_article(p.element->type()) + " takes " + std::to_string(low) +
                               (high > low ? " or " + std::to_string(high) : std::string())});
    const std::size_t before = findings_.size();
    ParameterCheck check(place(p.name), findings_);
    p.element->check(check);
    const bool sound = count_fits && findings_.size() == before;
    if (!sound) {
      inertia_in_doubt_ |= !resolved;
      faulty();
      continue;
    }
    bool right = true, ties = false, kinds_known = false;
    const bool inside =
        parts.for_each(*p.element, nodes, [&](const Terms& terms, const std::vector<int>& of_part) {
          right = right && check_terms(terms, of_part, p);
          ties = ties || !right || !terms.mass.isZero(0.0) || !terms.constraints.empty();
          if (!right || !usable) return;
          if (!kinds_known) usable = check_kinds(p, nodes);
          kinds_known = true;
          if (usable) keep(e, of_part, terms);
        });
    if (!inside) {
      findings_.push_back({place(p.name), "part_nodes()", "", "",
                           "must name nodes of the element, 0 to " + std::to_string(nodes.size() - 1)});
      right = false;
    }
    if (!resolved) inertia_in_doubt_ |= ties;
    if (!right || !usable) faulty();
  }
}

void SystemBuilder::keep_entries(const std::vector<int>& nodes, const Eigen::MatrixXd& matrix,
                                 NodeMatrix& sum) {
  for (Eigen::Index j = 0; j < matrix.cols(); ++j)
    for (Eigen::Index i = 0; i <= j; ++i)
      if (matrix(i, j) != 0.0)
        sum.add(nodes[static_cast<std::size_t>(i)], nodes[static_cast<std::size_t>(j)], matrix(i, j));
}

const LawPiece* straight_line(const ScalarSpec& s) {
  const std::span<const LawPiece> pieces = linear_pieces(s);
  if (pieces.size() != 1) return nullptr;
  const LawPiece& p = pieces.front();
  const bool straight = p.bounds.empty() && p.y_0 == 0.0 && p.elastic_0 == 0.0 && p.elastic_k == p.k;
  return straight ? &p : nullptr;
}

void SystemBuilder::keep(int element, const std::vector<int>& nodes, const Terms& terms) {
  const ElementId id{element};
  keep_entries(nodes, terms.mass, mass_[terms.rayleigh]);
  keep_entries(nodes, terms.damping, damping_);
  keep_entries(nodes, terms.deviation_damping, deviation_damping_);
  keep_entries(nodes, terms.stiffness, stiffness_[terms.rayleigh]);
  rayleigh_a_ += terms.rayleigh_a;
  rayleigh_b_ += terms.rayleigh_b;
  const auto add_closure = [&](const std::vector<Entry>& b, const SpeedRatioConstraint& how) {
    if (b.empty()) return;
    if (b.size() > 2) {
      WideRatioRow wide;
      for (const Entry& e : b) wide.b.emplace_back(e.index, e.coeff);
      wide.only_in_contact = how.only_in_contact;
      wide.element = element;
      wide_ratio_rows_.push_back(std::move(wide));
      return;
    }
    RatioRow row;
    row.element = element;
    row.only_in_contact = how.only_in_contact;
    row.holds_deviation = how.holds_deviation;
    row.ratio_only = how.ratio_only;
    row.first = b[0].index, row.b_first = b[0].coeff;
    if (b.size() > 1) row.second = b[1].index, row.b_second = b[1].coeff;
    ratio_rows_.push_back(row);
  };
  for (const SpeedRatioConstraint& c : terms.speed_ratio_constraints) add_closure(over_nodes(c.b, nodes), c);
  for (const LocalRow& row : terms.constraints) {
    const std::vector<Entry> b = over_nodes(row, nodes);
    add_closure(b, {});
    if (b.size() > 2) {
      wide_constraints_.push_back({id, b});
      continue;
    }
    system_.ideal_ratios_.push_back({id, b[0].index, b[1].index, b[0].coeff, b[1].coeff});
  }
  for (const ScalarSpec& s : terms.scalars) {
    if (const LawPiece* line = straight_line(s)) {
      const Eigen::MatrixXd square = s.b * s.b.transpose();
      keep_entries(nodes, line->c * square, damping_);
      keep_entries(nodes, line->k * square, stiffness_[false]);
      continue;
    }
    ScalarTerm term;
    term.element = id;
    term.force = s.force;
    term.nodes = over_nodes(s.b, nodes);
    term.phase_node = s.phase_node < 0 ? -1 : nodes[idx(s.phase_node)];
    term.along_line_of_action = s.along_line_of_action;
    term.varies = s.force->varies();
    system_.scalars_.push_back(std::move(term));
  }
  for (const FrequencySpec& f : terms.frequency_stiffnesses)
    system_.frequency_terms_.push_back({id, f.stiffness, over_nodes(f.b, nodes), {}});
  for (const LoadSpec& l : terms.loads)
    system_.loads_.push_back({id, nodes[idx(l.node)], l.load, -1, l.suffix});
  for (const GeneralForce* g : terms.generals) {
    system_.generals_.push_back({id, g, nodes, system_.history_size_, {}});
    system_.history_size_ += g->history_size();
    system_.symmetric_tangent_ &= g->symmetric_tangent();
  }
  for (const FrictionSpec& f : terms.frictions) {
    system_.frictions_.push_back({id, f.friction, over_nodes(f.b, nodes), system_.history_size_});
    system_.history_size_ += FrictionHistory::size(*f.friction);
  }
}

std::vector<OutputTerm> System::outputs() const {
  std::vector<OutputTerm> outputs;
  for_each_stated(*this, [&](int element, const Terms& terms, const std::vector<int>& of_part) {
    const ElementId id{element};
    for (const OutputSpec& o : terms.outputs) {
      outputs.push_back({id, o.suffix, over_nodes(o.stiffness, of_part), over_nodes(o.damping, of_part)});
      if (o.deflection.size() > 0)
        outputs.push_back({id, o.suffix, over_nodes(o.deflection, of_part), {}, false, true});
    }
    for (const ScalarSpec& s : terms.scalars)
      if (const LawPiece* line = straight_line(s)) {
        const bool along = s.along_line_of_action;
        outputs.push_back(
            {id, "", over_nodes(line->k * s.b, of_part), over_nodes(line->c * s.b, of_part), along});
        outputs.push_back({id, "", over_nodes(s.b, of_part), {}, along, true});
      }
  });
  return outputs;
}

namespace {

/// What an element of one's own may get wrong.
void check_friction(const Friction& friction, ParameterCheck check) {
  const std::vector<double>&speeds = friction.slip_speeds(), &torques = friction.sliding_torques();
  check.increasing("slip speeds", speeds, "rad/s");
  if (speeds.empty() || speeds.front() != 0.0 || speeds.size() != torques.size())
    check.fail("slip speeds", std::to_string(speeds.size()), "points",
               "must begin at 0, with a sliding torque for each");
  for (const double torque : torques) check.non_negative("sliding torque", torque, "N m");
  check.all_finite("breakpoints", friction.breakpoints(), "s");
  if (const GearLoss* loss = friction.gear_loss())
    for (const auto* values :
         {&loss->forward, &loss->backward, &loss->bearing_forward, &loss->bearing_backward})
      if (values->size() != loss->speeds.size())
        check.fail("gear loss", std::to_string(values->size()), "points", "must be as many as speeds");
  if (!(friction.break_away() >= 1.0))
    check.fail("break-away ratio", to_text(friction.break_away()), "", "must be >= 1");
}

}  // namespace

bool SystemBuilder::check_terms(const Terms& terms, const std::vector<int>& nodes, const ElementInstance& p) {
  const std::size_t before = findings_.size();
  const auto n = static_cast<Eigen::Index>(nodes.size());
  const auto fail = [&](const std::string& what, std::string value, std::string range) {
    findings_.push_back({place(p.name), "describe(): " + what, std::move(value), "", std::move(range)});
  };
  const auto matrix = [&](const char* name, const Eigen::MatrixXd& m) {
    if (m.rows() != n || m.cols() != n)
      fail(name, std::to_string(m.rows()) + " x " + std::to_string(m.cols()),
           "must be n x n for n = " + std::to_string(n) + " nodes");
    else if (!m.allFinite())
      fail(name, "not finite", "must be finite");
    else if (!m.isZero(0.0) && !m.isApprox(m.transpose(), 1e-12))
      fail(name, "not symmetric", "must be symmetric; a general force may be otherwise");
  };
  // Number of entries that are not zero; -1 after a finding.
  const auto row = [&](const char* name, const LocalRow& b, bool may_be_empty) {
    if (may_be_empty && b.size() == 0) return 0;
    if (b.size() != n)
      fail(name, std::to_string(b.size()) + " entries",
           "must have one for each of " + std::to_string(n) + " nodes");
    else if (!b.allFinite())
      fail(name, "not finite", "must be finite");
    else
      return static_cast<int>((b.array() != 0.0).count());
    return -1;
  };
  const auto contradiction = [&](const std::string& of, const Contradiction& wrong) {
    fail(of + ", " + wrong.what, wrong.detail, "must agree with its call; check_element() finds all places");
  };
  matrix("mass", terms.mass);
  matrix("damping", terms.damping);
  matrix("stiffness", terms.stiffness);
  if (terms.deviation_damping.size() > 0) matrix("deviation_damping", terms.deviation_damping);
  for (const ScalarSpec& s : terms.scalars) {
    const int entries = row("scalar b", s.b, false);
    if (entries == 0) fail("scalar b", "0", "must have an entry that is not 0");
    if (!s.force)
      fail("scalar force", "", "is missing (a null pointer)");
    else if (const auto wrong = first_contradiction(*s.force))
      contradiction("law " + std::to_string(&s - terms.scalars.data()), *wrong);
    if (s.phase_node < -1 || s.phase_node >= n)
      fail("phase_node", std::to_string(s.phase_node), "is no node of the element");
    if (entries > 0 && s.along_line_of_action)
      for (Eigen::Index i = 0; i < n; ++i) {
        const int node = nodes[static_cast<std::size_t>(i)];
        if (s.b[i] == 0.0 || node < 0) continue;
        // Gears turn, and their centres, of which no nominal speed follows, move.
        const auto& ties = terms.speed_ratio_constraints;
        const bool gear =
            !p.element->mixes_kinds() || std::any_of(ties.begin(), ties.end(), [i](const auto& tie) {
              return !tie.ratio_only && tie.b.size() > i && tie.b[i] != 0.0;
            });
        const bool turns = system_.node_kinds_[idx(node)] == NodeKind::rotational;
        if (gear != turns)
          findings_.push_back({place(p.name), "node " + std::to_string(i + 1), node_name(node), "",
                               gear ? "is translational; a gear needs a rotational node"
                                    : "is rotational; a gear's centre moves on a translational node"});
      }
  }
  for (const FrequencySpec& f : terms.frequency_stiffnesses) {
    row("frequency stiffness b", f.b, false);
    if (!f.stiffness) fail("frequency stiffness", "", "is missing (a null pointer)");
  }
  for (const LoadSpec& l : terms.loads) {
    if (l.node < 0 || l.node >= n) fail("load node", std::to_string(l.node), "is no node of the element");
    if (!l.load) {
      fail("load", "", "is missing (a null pointer)");
      continue;
    }
    ParameterCheck(place(p.name), findings_).all_finite("breakpoints", l.load->breakpoints(), "s");
    if (const auto wrong = first_contradiction(*l.load))
      contradiction("load " + std::to_string(&l - terms.loads.data()), *wrong);
  }
  for (const GeneralForce* g : terms.generals) {
    if (!g) fail("general force", "", "is missing (a null pointer)");
    if (g && g->history_size() < 0) fail("history_size", std::to_string(g->history_size()), "must be >= 0");
    if (n > kMaxLocalDofs)
      fail("general force", std::to_string(n) + " nodes",
           "must have at most " + std::to_string(kMaxLocalDofs));
  }
  for (const FrictionSpec& f : terms.frictions) {
    if (row("friction b", f.b, false) == 0) fail("friction b", "0", "must have an entry that is not 0");
    if (!f.friction)
      fail("friction", "", "is missing (a null pointer)");
    else
      check_friction(*f.friction, ParameterCheck(place(p.name), findings_));
    if (f.friction && f.friction->gear_loss() &&
        (&f == terms.frictions.data() || !(&f - 1)->friction || !(&f - 1)->friction->rigid()))
      fail("gear loss", "", "must be stated just behind the tie of its gear");
  }
  for (const SpeedRatioConstraint& c : terms.speed_ratio_constraints)
    row("speed ratio constraint", c.b, false);
  for (const LocalRow& b : terms.constraints) {
    const int entries = row("constraint", b, false);
    if (entries == 0 || entries == 1)
      fail("constraint", std::to_string(entries) + " nodes", "must tie at least two");
  }
  for (const OutputSpec& o : terms.outputs) {
    row("output stiffness", o.stiffness, true);
    row("output damping", o.damping, true);
    row("output deflection", o.deflection, true);
  }
  if (terms.rayleigh_a != 0.0 || terms.rayleigh_b != 0.0) {
    ParameterCheck check(place(p.name), findings_);
    check.non_negative("describe(): rayleigh_a", terms.rayleigh_a, "1/s");
    check.non_negative("describe(): rayleigh_b", terms.rayleigh_b, "s");
  }
  return findings_.size() == before;
}

bool SystemBuilder::check_kinds(const ElementInstance& p, const std::vector<int>& nodes) {
  if (p.element->mixes_kinds()) return true;
  for (const int node : nodes) {
    const NodeKind first = system_.node_kinds_[idx(nodes.front())];
    if (system_.node_kinds_[idx(node)] == first) continue;
    const bool turns = first == NodeKind::rotational;
    findings_.push_back({place(p.name), "node", node_name(node), "",
                         std::string("is ") + (turns ? "translational" : "rotational") + " and " +
                             node_name(nodes.front()) + " is " + (turns ? "rotational" : "translational") +
                             "; " + with_article(p.element->type()) + " joins nodes of one kind"});
    return false;
  }
  return true;
}

}  // namespace drev
