/// Rack: a rack of mass m on a pinion of radius r, through teeth of stiffness k that push along the rack.
///
///   y = k x  [N],  x = r theta - s [m];   m s'' = y, and the pinion feels -r y
///
/// Positive force is that of a pinion ahead of its rack. Nodes: the pinion; the rack is the internal node.
#include <drev/app/model_file/plugin.hpp>
#include <drev/elements/own_element.hpp>

namespace {

using namespace drev;

struct ToothLaw {
  double k = kNotGiven;  ///< N/m, > 0
  ScalarResponse operator()(const ScalarInput& in) const {
    return {.y = k * in.x, .dy_dx = k, .stored_energy = 0.5 * k * in.x * in.x};
  }
};

class Rack final : public Element {
 public:
  struct Params {
    double mass = kNotGiven;    ///< m, kg, > 0
    double radius = kNotGiven;  ///< r, m, > 0
    ToothLaw teeth;
  };
  explicit Rack(Params p) : params_(p), teeth_(p.teeth) {}
  std::string_view type() const override { return "rack"; }
  int min_nodes() const override { return 1; }
  std::vector<NodeKind> internal_nodes() const override { return {NodeKind::translational}; }
  bool mixes_kinds() const override { return true; }
  void check(ParameterCheck& check) const override {
    check.positive("mass", params_.mass, "kg");
    check.positive("radius", params_.radius, "m");
    check.positive("stiffness", params_.teeth.k, "N/m");
  }
  void describe(int, Terms& terms) const override {
    LocalRow b(2);
    b << params_.radius, -1.0;
    terms.mass(1, 1) = params_.mass;
    terms.scalars.push_back({.b = b, .force = &teeth_});
    terms.speed_ratio_constraints.push_back({.b = b});
  }
  const Params& params() const { return params_; }

 private:
  Params params_;
  LawForce<ToothLaw> teeth_;
};

}  // namespace

DREV_PLUGIN() {
  using namespace drev::app;
  register_element<Rack>("rack", [](Fields& f, Rack::Params& p) {
    f.number({"mass", Dimension::mass}, p.mass, Need::required);
    f.number({"radius", Dimension::length}, p.radius, Need::required);
    f.number({"stiffness", Dimension::stiffness}, p.teeth.k, Need::required);
  });
}
