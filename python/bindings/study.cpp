// Many variants with a row of figures each (app/variants): the rows of a range of blocks, for Python code
// that distributes the work.
#include <limits>
#include <map>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>
#include <numeric>
#include <stdexcept>

#include "app/commands/run_variants.hpp"
#include "app/results/hdf5_file.hpp"
#include "app/variants/variant_store.hpp"
#include "python/bindings/arrays.hpp"
#include "python/bindings/request.hpp"

namespace drev::python {

namespace {

using app::VariantStudy;

using GivenRows = nb::ndarray<const double, nb::ndim<1>, nb::c_contig, nb::device::cpu>;

/// Rows of `count` blocks from `first` on, and for each block the reasons of its failed variants
/// (app::BlockRows).
struct Rows {
  std::vector<double> numbers;
  std::vector<std::vector<std::string>> reasons;
};

Rows rows_of(const VariantStudy& study, std::uint64_t first, std::uint64_t count, const Stop& stop) {
  const nb::gil_scoped_release unlocked;
  Rows rows;
  for (std::uint64_t block = first; block < first + count && block < study.blocks(); ++block) {
    const auto found = study.run(block, [&] { return !stop.is_set(); });
    if (!found) break;
    const auto size = static_cast<std::ptrdiff_t>(study.count_of(block) * study.row_size());
    rows.numbers.insert(rows.numbers.end(), found->numbers.begin(), found->numbers.begin() + size);
    rows.reasons.push_back(found->reasons);
  }
  return rows;
}

/// A study's store in a folder (app/variants/variant_store.hpp), for Python code that has its blocks
/// computed.
class StudyStore {
 public:
  StudyStore(const VariantStudy& study, const std::string& folder, bool resume)
      : study_(study), folder_(folder) {
    app::check_study_folder(study, folder, resume);
    complete_ = resume && !app::VariantStore::description_in(folder) && app::study_of_table(folder);
    if (complete_) return;  // the rows are in the table
    store_.emplace(folder, study.description().dump(), study.store_shape(), resume);
  }

  bool complete() const { return complete_; }
  /// The blocks that are not done yet, as (first, count).
  std::vector<std::pair<std::uint64_t, std::uint64_t>> missing() const {
    std::vector<std::pair<std::uint64_t, std::uint64_t>> parts;
    for (std::uint64_t block = 0; block < study_.blocks() && !complete_; ++block) {
      if (store_->done(block)) continue;
      if (parts.empty() || parts.back().first + parts.back().second != block) parts.emplace_back(block, 0);
      ++parts.back().second;
    }
    return parts;
  }
  /// Stores rows as VariantStudy gives them, from a block on; they are on the disk after sync().
  void put(std::uint64_t first, const GivenRows& numbers,
           const std::vector<std::vector<std::string>>& reasons) {
    const double* next = numbers.data();
    const double* end = next + numbers.size();
    for (std::size_t i = 0; i < reasons.size(); ++i) {
      const auto size = static_cast<std::ptrdiff_t>(study_.count_of(first + i) * study_.row_size());
      if (end - next < size) throw std::invalid_argument("rows of fewer blocks than reasons");
      app::BlockRows rows{{next, next + size}, reasons[i]};
      rows.numbers.resize(study_.block_size() * study_.row_size(), std::numeric_limits<double>::quiet_NaN());
      if (!store_->done(first + i)) store_->put(first + i, rows);
      next += size;
    }
  }
  void sync() { store_->sync(); }
  std::string path() const { return app::VariantStore::path_in(folder_); }
  /// Why variants failed, and the warnings of others, by their numbers: all there are, or of a table that is complete already
  /// those which its summary lists.
  std::map<std::uint64_t, std::string> reasons() const {
    std::map<std::uint64_t, std::string> all;
    if (complete_) {
      const app::Json summary = app::summary_of_table(folder_).value_or(app::Json::object());
      for (const app::Json& failure : summary.value("failures", app::Json::array()))
        all.emplace(failure.at("variant"), failure.at("reason"));
      for (const app::Json& warning : summary.value("warnings", app::Json::array()))
        all.emplace(warning.at("variant"), warning.at("warning"));
      return all;
    }
    for (std::uint64_t block = 0; block < study_.blocks(); ++block) {
      const std::vector<std::string> of_block = store_->get(block).reasons;
      for (std::size_t i = 0; i < of_block.size(); ++i)
        if (!of_block[i].empty()) all.emplace(study_.first_of(block) + i, of_block[i]);
    }
    return all;
  }
  /// All rows, from the store or the table.
  std::vector<double> rows() const {
    std::vector<double> all;
    if (complete_) {
      std::vector<std::uint64_t> places(study_.plan().count());
      std::iota(places.begin(), places.end(), std::uint64_t{0});
      all.resize(places.size() * study_.row_size());
      for (std::size_t column = 0; column < study_.row_size(); ++column) {
        const std::string name = column == 0 ? "status" : study_.figures()[column - 1].name;
        const std::vector<double> values = app::hdf5_numbers(app::table_path(folder_), name, places);
        for (std::size_t i = 0; i < values.size(); ++i) all[i * study_.row_size() + column] = values[i];
      }
      return all;
    }
    for (std::uint64_t block = 0; block < study_.blocks(); ++block) {
      const app::BlockRows rows = store_->get(block);
      all.insert(
          all.end(), rows.numbers.begin(),
          rows.numbers.begin() + static_cast<std::ptrdiff_t>(study_.count_of(block) * study_.row_size()));
    }
    return all;
  }
  void finish() { app::finish_table(study_, *store_, folder_); }

 private:
  const VariantStudy& study_;
  std::string folder_;
  std::optional<app::VariantStore> store_;
  bool complete_ = false;
};

}  // namespace

void bind_study(nb::module_& module) {
  nb::class_<Rows>(module, "StudyRows")
      .def_prop_ro("numbers", [](nb::object self) { return array_of(nb::cast<Rows&>(self).numbers, self); })
      .def_ro("reasons", &Rows::reasons);
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
  nb::class_<StudyStore>(module, "StudyStore")
      .def(nb::init<const VariantStudy&, const std::string&, bool>(), nb::keep_alive<1, 2>())
      .def_prop_ro("complete", &StudyStore::complete)
      .def_prop_ro("path", &StudyStore::path)
      .def("missing", &StudyStore::missing)
      .def("put", &StudyStore::put)
      .def("sync", &StudyStore::sync, nb::call_guard<nb::gil_scoped_release>())
      .def("rows", &StudyStore::rows)
      .def("reasons", &StudyStore::reasons)
      .def("finish", &StudyStore::finish, nb::call_guard<nb::gil_scoped_release>());
  nb::list names;
  for (int i = 0; i < app::kVariantStatuses; ++i)
    names.append(app::status_text(static_cast<app::VariantStatus>(i)));
  module.attr("variant_statuses") = names;
}

}  // namespace drev::python
