// Registers one type of its own, then one that drev has: neither may stay.
#include <drev/app/model_file/plugin.hpp>
#include <drev/elements/catalogue.hpp>

DREV_PLUGIN() {
  using namespace drev::app;
  const auto list = [](Fields& f, drev::Inertia::Params& p) {
    f.number({"value", Dimension::none}, p.inertia, Need::required);
  };
  register_element<drev::Inertia>("plain_inertia", list);
  register_element<drev::Inertia>("shaft_spring", list);
}
