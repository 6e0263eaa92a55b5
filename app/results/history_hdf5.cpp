#include "app/results/history_hdf5.hpp"

#include <drev/core/version.hpp>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <hdf5.h>
#include <limits>
#include <optional>
#include <utility>

#include "app/base/output_file.hpp"

namespace drev::app {

namespace {

constexpr hsize_t kBlock = 1024;  // rows

/// Closes what HDF5 has opened.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT: HDF5 wants the number
  bool close() { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

class Hdf5File {
 public:
  explicit Hdf5File(const std::string& path) : path_(path), file_(create(path), H5Fclose) {
    check(file_ >= 0);
  }

  void add_text(hid_t object, const char* name, const std::string& text) {
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate(H5S_SCALAR), H5Sclose);
    check(H5Tset_size(type, H5T_VARIABLE) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0);
    const char* characters = text.c_str();
    const Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
    check(attribute >= 0 && H5Awrite(attribute, type, &characters) >= 0);
  }

  /// Grows block by block.
  void add_column(const HistoryColumn& column) {
    const hsize_t none = 0, unlimited = H5S_UNLIMITED;
    const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose);
    const Handle chunks(H5Pcreate(H5P_DATASET_CREATE), H5Pclose), links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    H5Pset_chunk(chunks, 1, &kBlock);
    H5Pset_create_intermediate_group(links, 1);  // a name with a slash
    columns_.emplace_back(
        H5Dcreate2(file_, column.name.c_str(), H5T_NATIVE_DOUBLE, space, links, chunks, H5P_DEFAULT),
        H5Dclose);
    check(columns_.back() >= 0);
    if (!column.unit.empty()) add_text(columns_.back(), "unit", column.unit);
  }

  void add_texts(const std::string& name, const std::vector<std::string>& texts) {
    const hsize_t count = texts.size();
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose), space(H5Screate_simple(1, &count, nullptr), H5Sclose),
        links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
    check(H5Tset_size(type, H5T_VARIABLE) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0);
    H5Pset_create_intermediate_group(links, 1);
    const Handle set(H5Dcreate2(file_, name.c_str(), type, space, links, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
    std::vector<const char*> characters;
    for (const std::string& text : texts) characters.push_back(text.c_str());
    check(set >= 0 &&
          (count == 0 || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, characters.data()) >= 0));
  }

  void append(std::size_t column, hsize_t at, const std::vector<double>& values) {
    const hsize_t count = values.size(), size = at + count;
    const hid_t set = columns_[column];
    check(H5Dset_extent(set, &size) >= 0);
    const Handle to(H5Dget_space(set), H5Sclose), from(H5Screate_simple(1, &count, nullptr), H5Sclose);
    check(H5Sselect_hyperslab(to, H5S_SELECT_SET, &at, nullptr, &count, nullptr) >= 0 &&
          H5Dwrite(set, H5T_NATIVE_DOUBLE, from, to, H5P_DEFAULT, values.data()) >= 0);
  }

  void close() {
    for (Handle& column : columns_) check(column.close());
    check(H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0);
    check(file_.close());
  }
  hid_t id() const { return file_; }

 private:
  static hid_t create(const std::string& path) {
    H5dont_atexit();  // or HDF5 tries at the end to write what a full disk would not take, and crashes
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are ours to tell
    const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    H5Pset_file_locking(access, 0, 1);  // OutputFile has locked it
    return H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  }

  void check(bool good) const {
    if (good) return;
    std::string reason = "HDF5 failed";
    H5Ewalk2(
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned n, const H5E_error2_t* error, void* text) -> herr_t {
          if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
          return 0;
        },
        &reason);
    // Of "file write failed: ..., errno = 28, error message = 'No space left on device', ..." what matters.
    const std::string marker = "error message = '";
    if (const std::size_t at = reason.find(marker); at != std::string::npos)
      reason = reason.substr(at + marker.size(), reason.find('\'', at + marker.size()) - at - marker.size());
    throw OutputError("cannot write " + path_ + ": " + reason);
  }

  std::string path_;
  Handle file_;
  std::vector<Handle> columns_;
};

/// The cells of a line of CSV as csv_cell() writes them; moves past its end.
std::vector<std::string> cells_of(const std::string& csv, std::size_t& at) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (; at < csv.size(); ++at) {
    const char c = csv[at];
    if (c == '"') {
      if (quoted && at + 1 < csv.size() && csv[at + 1] == '"')
        cells.back() += csv[++at];
      else
        quoted = !quoted;
    } else if (c == ',' && !quoted) {
      cells.emplace_back();
    } else if (c == '\n' && !quoted) {
      ++at;
      break;
    } else {
      cells.back() += c;
    }
  }
  for (std::string& cell : cells)
    if (!cell.empty() && cell.front() == '\'') cell.erase(0, 1);
  return cells;
}

/// Numbers, if all cells are; an empty one is not a number.
std::optional<std::vector<double>> numbers_of(const std::vector<std::string>& cells) {
  std::vector<double> numbers;
  for (const std::string& cell : cells) {
    char* end = nullptr;
    numbers.push_back(cell.empty() ? std::numeric_limits<double>::quiet_NaN()
                                   : std::strtod(cell.c_str(), &end));
    if (!cell.empty() && *end != '\0') return std::nullopt;
  }
  return numbers;
}

}  // namespace

void write_tables_hdf5(const std::string& path, const std::vector<TableText>& tables,
                       const std::string& summary) {
  const std::string extension = ".h5", name = std::filesystem::path(path).filename().string();
  create_directory(folder_of(path));
  OutputFile file(folder_of(path), name.substr(0, name.size() - extension.size()), "h5");
  {
    Hdf5File h5(file.partial_path());
    h5.add_text(h5.id(), "drev", DREV_VERSION);
    h5.add_text(h5.id(), "summary", summary);
    std::size_t number = 0;
    for (const TableText& table : tables) {
      std::size_t at = 0;
      const std::vector<std::string> names = cells_of(table.csv, at);
      std::vector<std::vector<std::string>> columns(names.size());
      while (at < table.csv.size()) {
        const std::vector<std::string> row = cells_of(table.csv, at);
        for (std::size_t c = 0; c < columns.size() && c < row.size(); ++c) columns[c].push_back(row[c]);
      }
      for (std::size_t c = 0; c < names.size(); ++c) {
        const std::string place = table.name + "/" + names[c];
        if (const auto numbers = numbers_of(columns[c])) {
          h5.add_column({place, ""});
          if (!numbers->empty()) h5.append(number, 0, *numbers);
          ++number;
        } else {
          h5.add_texts(place, columns[c]);
        }
      }
    }
    h5.close();
  }
  file.commit();
}

void write_hdf5(const std::string& directory, const std::string& csv,
                const std::vector<HistoryColumn>& columns, const std::string& summary) {
  std::ifstream in(csv);
  std::string line;
  if (!std::getline(in, line)) throw OutputError("cannot read " + csv + ": " + std::strerror(errno));
  OutputFile file(directory, "history", "h5");
  {
    Hdf5File h5(file.partial_path());
    h5.add_text(h5.id(), "drev", DREV_VERSION);
    h5.add_text(h5.id(), "summary", summary);
    h5.add_column({"time_s", "s"});
    for (const HistoryColumn& column : columns) h5.add_column(column);
    std::vector<std::vector<double>> block(columns.size() + 1);
    hsize_t rows = 0;
    const auto empty_block = [&] {
      if (block[0].empty()) return;
      for (std::size_t c = 0; c < block.size(); ++c) h5.append(c, rows, block[c]);
      rows += block[0].size();
      for (std::vector<double>& values : block) values.clear();
    };
    while (std::getline(in, line)) {
      char* at = line.data();
      for (std::vector<double>& values : block) {
        values.push_back(std::strtod(at, &at));
        if (*at == ',') ++at;
      }
      if (block[0].size() == kBlock) empty_block();
    }
    empty_block();
    h5.close();
  }
  file.commit();
}

}  // namespace drev::app
