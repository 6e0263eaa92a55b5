// Many variants with a row of figures each (app/variants): the rows of a range of blocks, for whoever shares the work out.
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "app/commands/run_variants.hpp"
#include "app/variants/variant_study.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

using app::VariantStudy;

/// Rows of `count` blocks from `first` on, and where they are kept.
struct Rows {
  std::vector<double> numbers;
  std::size_t columns = 0;
};

Rows rows_of(const VariantStudy& study, std::uint64_t first, std::uint64_t count, const Stop& stop) {
  const nb::gil_scoped_release unlocked;
  Rows rows{{}, study.row_size()};
  for (std::uint64_t block = first; block < first + count && block < study.blocks(); ++block) {
    const auto found = study.run(block, [&] { return !stop.is_set(); });
    if (!found) break;
    const auto size = static_cast<std::ptrdiff_t>(study.count_of(block) * study.row_size());
    rows.numbers.insert(rows.numbers.end(), found->numbers.begin(), found->numbers.begin() + size);
  }
  return rows;
}

}  // namespace

void bind_study(nb::module_& module) {
  nb::class_<Rows>(module, "StudyRows").def_prop_ro("numbers", [](nb::object self) {
    return array_of(nb::cast<Rows&>(self).numbers, self);
  });
  nb::class_<VariantStudy>(module, "Study")
      .def("__init__", [](VariantStudy* self,
                          const Request& request) { new (self) VariantStudy(app::study_of(request.line())); })
      .def_prop_ro("count", [](const VariantStudy& s) { return s.plan().count(); })
      .def_prop_ro("blocks", &VariantStudy::blocks)
      .def_prop_ro("block_size", &VariantStudy::block_size)
      .def_prop_ro("description", [](const VariantStudy& s) { return s.description().dump(); })
      .def_prop_ro("figures",
                   [](const VariantStudy& s) {
                     std::vector<std::pair<std::string, std::string>> all;
                     for (const app::FigureColumn& f : s.figures()) all.emplace_back(f.name, f.unit);
                     return all;
                   })
      .def("parameters", [](const VariantStudy& s, std::uint64_t i) { return s.plan().parameters(i); })
      .def("rows", &rows_of, nb::arg("first"), nb::arg("count"), nb::arg("stop"));
  nb::list names;
  for (int i = 0; i < app::kVariantStatuses; ++i)
    names.append(app::status_text(static_cast<app::VariantStatus>(i)));
  module.attr("variant_statuses") = names;
}

}  // namespace drev::python
