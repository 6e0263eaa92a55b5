#include <drev/solvers/run/recorder.hpp>

#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/commands/run_request.hpp"
#include "app/report/run_files.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

/// The outcome of a run, with the recorded channels.
struct Run {
  app::RunOutcome outcome;
  std::optional<Recorder> recorder;
  std::vector<double> no_times = {};  ///< times of a run that never began
  bool stopped = false;

  const std::vector<double>& times() const { return recorder ? recorder->times() : no_times; }
};

Run* run(const Request& asked) {
  app::CommandLine line = asked.line();
  line.keeps_history = true;
  auto result = std::make_unique<Run>();
  Watch watch(asked);
  {
    const nb::gil_scoped_release unlocked;
    app::RunRequest request = app::request_run(line);
    const auto watchers = [&result, record = request.record,
                           every = request.every](const System& system) -> std::vector<Observer*> {
      return {&result->recorder.emplace(system, record, every)};
    };
    result->outcome = app::run_and_write(std::move(request), watchers);
  }
  result->stopped = watch.stopped();
  return result.release();
}

}  // namespace

void bind_run(nb::module_& module) {
  nb::class_<Run>(module, "Run")
      .def_prop_ro("status", [](const Run& r) { return r.outcome.status; })
      .def_prop_ro("warning", [](const Run& r) { return r.outcome.warning; })
      .def_prop_ro("text", [](const Run& r) { return r.outcome.text; })
      .def_prop_ro("json", [](const Run& r) { return r.outcome.json; })
      .def_prop_ro("notes", [](const Run& r) { return r.outcome.notes; })
      .def_prop_ro("written", [](const Run& r) { return r.outcome.written; })
      .def_ro("stopped", &Run::stopped)
      .def_prop_ro("times",
                   [](nb::handle self) { return array_of(nb::cast<const Run&>(self).times(), self); })
      .def_prop_ro("channels",
                   [](const Run& r) {
                     nb::list all;
                     if (r.recorder)
                       for (const Channel& c : r.recorder->channels())
                         all.append(nb::make_tuple(c.name(), c.unit()));
                     return all;
                   })
      .def("samples", [](nb::handle self, std::size_t channel) {
        const Run& r = nb::cast<const Run&>(self);
        if (!r.recorder || channel >= r.recorder->channels().size()) throw nb::index_error("channel");
        return array_of(r.recorder->samples(channel), self);
      });
  module.def("run", &run, nb::arg("request"), nb::rv_policy::take_ownership);
}

}  // namespace drev::python
