#include <drev/app/model_file/plugin.hpp>
#include <drev/elements/own_element.hpp>

/// y = k x + k3 x^3 [N m], x = twist of end b against end a [rad].
struct Hardening {
  static constexpr std::string_view type = "hardening coupling";
  double k = 0.0, k3 = 0.0;  ///< N m/rad, > 0; N m/rad^3, >= 0
  drev::ScalarResponse operator()(const drev::ScalarInput& in) const {
    const double x = in.x, x2 = x * x;
    return {.y = (k + k3 * x2) * x, .dy_dx = k + 3 * k3 * x2, .stored_energy = (k / 2 + k3 * x2 / 4) * x2};
  }
  void check(drev::ParameterCheck& check) const {
    check.positive("stiffness", k, "N m/rad");
    check.non_negative("cubic_Nm_per_rad3", k3, "N m/rad^3");
  }
};

DREV_PLUGIN() {
  using namespace drev::app;
  register_element<drev::LawElement<Hardening>>("hardening_coupling", [](Fields& f, Hardening& p) {
    f.number({"stiffness", Dimension::torsional_stiffness}, p.k, Need::required);
    f.number({"cubic_Nm_per_rad3", Dimension::none}, p.k3);
  });
}
