/// Endless: a torque of 1 N m, whose evaluation does not come back after 0.01 s of the run.
#include <drev/app/model_file/plugin.hpp>
#include <drev/elements/own_element.hpp>

#include <chrono>
#include <thread>

namespace {

using namespace drev;

class Endless final : public Element, public Load {
 public:
  struct Params {};
  explicit Endless(Params) {}
  std::string_view type() const override { return "endless torque"; }
  int min_nodes() const override { return 1; }
  void check(ParameterCheck& /*check*/) const override {}
  void describe(int /*nodes*/, Terms& terms) const override { terms.loads.push_back({0, this}); }
  LoadResponse evaluate(const LoadInput& in) const override {
    while (in.t > 0.01) std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return {.torque = 1.0};
  }
  bool depends_on_motion() const override { return false; }
  Params params() const { return {}; }
};

}  // namespace

DREV_PLUGIN() {
  using namespace drev::app;
  register_element<Endless>("endless", [](Fields&, Endless::Params&) {});
}
