// Elements of one's own that describe themselves wrongly are findings, never a crash.
#include <drev/core/element.hpp>
#include <drev/core/general_force.hpp>
#include <drev/elements/catalogue.hpp>

#include <functional>
#include <limits>

#include "tests/catch.hpp"
#include "tests/problems/findings.hpp"

using namespace drev;
using problems::findings_of;
using problems::only_fault;

namespace {

/// Describes whatever the test wants.
class Anything final : public Element {
 public:
  using Describe = std::function<void(int, Terms&)>;
  Anything(int nodes, Describe describe, bool mixes = false)
      : nodes_(nodes), describe_(std::move(describe)), mixes_(mixes) {}
  std::string_view type() const override { return "thing"; }
  int min_nodes() const override { return nodes_; }
  void check(ParameterCheck&) const override {}
  void describe(int nodes, Terms& terms) const override { describe_(nodes, terms); }
  bool mixes_kinds() const override { return mixes_; }

 private:
  int nodes_;
  Describe describe_;
  bool mixes_;
};

class Spring final : public ScalarForce {
 public:
  ScalarResponse evaluate(const ScalarInput& in) const override { return {.y = 5.0 * in.x, .dy_dx = 5.0}; }
};

class BadLoad final : public Load {
 public:
  LoadResponse evaluate(const LoadInput&) const override { return {}; }
  std::vector<double> breakpoints() const override { return {1.0, std::numeric_limits<double>::infinity()}; }
};

class Nothing final : public GeneralForce {
 public:
  void evaluate(const LocalState&, LocalResponse&) const override {}
};

/// Nine discs n_0..n_8, and the element on the first ones.
Model with(int nodes, Anything::Describe describe, bool mixes = false) {
  Model m("own");
  for (int i = 0; i < 9; ++i) {
    const std::string name = "n_" + std::to_string(i);
    m.add_node(name, mixes && i == 1 ? NodeKind::translational : NodeKind::rotational);
    m.add<Inertia>("disc_" + std::to_string(i), {name}, {.inertia = 1.0});
  }
  std::vector<NodeRef> refs;
  for (int i = 0; i < nodes; ++i) refs.emplace_back("n_" + std::to_string(i));
  m.add("thing", refs, std::make_shared<Anything>(nodes, std::move(describe), mixes));
  return m;
}

LocalRow row(std::initializer_list<double> values) {
  LocalRow b(static_cast<Eigen::Index>(values.size()));
  Eigen::Index i = 0;
  for (const double v : values) b[i++] = v;
  return b;
}

}  // namespace

TEST_CASE("Descriptions of the wrong size or content are findings") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  static const Spring spring;
  static const BadLoad load;
  static const Nothing nothing;
  const auto bad = [](int nodes, Anything::Describe describe, std::vector<std::string> parts) {
    parts.emplace_back("own/thing");
    return only_fault(with(nodes, std::move(describe)), parts);
  };
  CHECK(bad(2, [](int, Terms& t) { t.mass = Eigen::MatrixXd::Zero(1, 1); }, {"mass = 1 x 1"}));
  CHECK(bad(2, [&](int, Terms& t) { t.stiffness(0, 1) = nan; }, {"stiffness", "finite"}));
  CHECK(bad(2,
            [](int, Terms& t) {
              t.scalars.push_back({.b = row({1, -1, 1}), .force = &spring});
            },
            {"scalar b = 3 entries"}));
  CHECK(bad(2, [](int, Terms& t) { t.scalars.push_back({.b = row({1, -1})}); }, {"scalar force", "null"}));
  CHECK(bad(2,
            [](int, Terms& t) {
              t.scalars.push_back({.b = row({0, 0}), .force = &spring});
            },
            {"scalar b", "not 0"}));
  CHECK(bad(2,
            [](int, Terms& t) {
              t.scalars.push_back({.b = row({1, -1}), .force = &spring, .phase_node = 2});
            },
            {"phase_node = 2"}));
  CHECK(findings_of(with(1, [](int, Terms& t) { t.loads.push_back({1, &load}); })).size() == 2);
  CHECK(bad(1, [](int, Terms& t) { t.loads.push_back({0, &load}); }, {"breakpoints[1] = infinity"}));
  CHECK(bad(1, [](int, Terms& t) { t.loads.push_back({0, nullptr}); }, {"load", "null"}));
  CHECK(bad(1, [](int, Terms& t) { t.generals.push_back(nullptr); }, {"general force", "null"}));
  CHECK(bad(9, [](int, Terms& t) { t.generals.push_back(&nothing); }, {"9 nodes", "at most 8"}));
  CHECK(bad(1, [](int, Terms& t) { t.constraints.push_back(row({1})); }, {"constraint = 1", "at least two"}));
  CHECK(bad(2,
            [](int, Terms& t) {
              t.outputs.push_back({"", row({1, 2, 3}), row({1, 2})});
            },
            {"output stiffness = 3 entries"}));
  CHECK(bad(0, [&](int, Terms& t) { t.rayleigh_a = nan; }, {"rayleigh_a"}));
}

TEST_CASE("A constraint ties the nodes that it names, wherever they stand in the element") {
  const System s = with(3, [](int, Terms& t) { t.constraints.push_back(row({2.0, 0.0, -1.0})); }).build();
  CHECK(s.size() == 8);
  CHECK(s.node_map(2).unknown == s.node_map(0).unknown);
  CHECK(s.node_map(2).coeff == Approx(2.0));
  CHECK(s.node_map(1).unknown != s.node_map(0).unknown);
}

TEST_CASE("An element may say that it joins rotational and translational nodes") {
  // A rack: x = 0.1 theta.
  const Anything::Describe rack = [](int, Terms& t) { t.constraints.push_back(row({0.1, -1.0})); };
  const System s = with(2, rack, true).build();
  CHECK(s.node_map(1).coeff == Approx(0.1));
}

TEST_CASE("General elements take as many nodes as fit") {
  static const Nothing nothing;
  CHECK(findings_of(with(8, [](int, Terms& t) { t.generals.push_back(&nothing); })).empty());
}
