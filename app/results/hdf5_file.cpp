#include "app/results/hdf5_file.hpp"

#include <algorithm>
#include <filesystem>
#include <hdf5.h>
#include <map>
#include <utility>

#include "app/base/output_file.hpp"
#include "app/base/text_layout.hpp"

namespace drev::app {

/// Owns an HDF5 identifier and closes it.
class Hdf5Handle {
 public:
  Hdf5Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept : id_(std::exchange(other.id_, -1)), close_(other.close_) {}
  Hdf5Handle& operator=(Hdf5Handle&&) = delete;
  ~Hdf5Handle() {
    if (id_ >= 0) close_(id_);
  }
  operator hid_t() const { return id_; }  // NOLINT: HDF5 takes the identifier as a number
  bool close() { return close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

namespace {

constexpr hsize_t kGrow = 1024;  // number of rows by which a column grows

Hdf5Handle text_type(std::size_t size) {
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  if (H5Tset_size(type, size) < 0 || H5Tset_cset(type, H5T_CSET_UTF8) < 0) return {-1, H5Tclose};
  return type;
}

/// HDF5 type of a column: an enumeration of one byte for a column with meanings, doubles without.
Hdf5Handle type_of(const Hdf5File::Column& column) {
  if (column.text_size > 0) return text_type(column.text_size);
  if (column.meanings.empty()) return {H5Tcopy(H5T_NATIVE_DOUBLE), H5Tclose};
  Hdf5Handle type(H5Tenum_create(H5T_NATIVE_INT8), H5Tclose);
  for (std::size_t i = 0; i < column.meanings.size(); ++i) {
    const auto value = static_cast<std::int8_t>(i);
    H5Tenum_insert(type, column.meanings[i].c_str(), &value);
  }
  return type;
}

Hdf5Handle opened_to_read(const std::string& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, 0, 1);
  return {H5Fopen(path.c_str(), H5F_ACC_RDONLY, access), H5Fclose};
}

}  // namespace

struct Hdf5File::Opened {
  Hdf5Handle set, type;
  Column column;
};

Hdf5File::Hdf5File(const std::string& path) : path_(path) {
  static_assert(sizeof(hid_t) == sizeof(std::int64_t));
  H5dont_atexit();  // otherwise HDF5 tries at exit to write what did not fit on a full disk, and crashes
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // drev reports errors itself
  const Hdf5Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_file_locking(access, 0, 1);  // OutputFile has locked the file
  file_ = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  check(file_ >= 0);
}

Hdf5File::~Hdf5File() {
  columns_.clear();
  if (file_ >= 0) H5Fclose(file_);
}

void Hdf5File::add_text(const std::string& name, const std::string& text) {
  add_text_to(file_, name.c_str(), text);
}

void Hdf5File::add_text_to(std::int64_t object, const char* name, const std::string& text) {
  const Hdf5Handle type = text_type(H5T_VARIABLE), space(H5Screate(H5S_SCALAR), H5Sclose);
  check(type >= 0);
  const char* characters = text.c_str();
  const Hdf5Handle attribute(H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute >= 0 && H5Awrite(attribute, type, &characters) >= 0);
}

void Hdf5File::add_column(const Column& column) {
  const hsize_t rows = column.rows, unlimited = H5S_UNLIMITED;
  const Hdf5Handle space(H5Screate_simple(1, &rows, rows == 0 ? &unlimited : nullptr), H5Sclose);
  const Hdf5Handle layout(H5Pcreate(H5P_DATASET_CREATE), H5Pclose),
      links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_obj_track_times(layout, false);
  if (rows == 0) H5Pset_chunk(layout, 1, &kGrow);
  H5Pset_create_intermediate_group(links, 1);  // for a name with a slash
  Hdf5Handle type = type_of(column);
  check(type >= 0);
  Hdf5Handle set(H5Dcreate2(file_, column.name.c_str(), type, space, links, layout, H5P_DEFAULT), H5Dclose);
  check(set >= 0);
  columns_.push_back({std::move(set), std::move(type), column});
  add_text_to(columns_.back().set, "unit", column.unit);
}

void Hdf5File::write_rows(std::size_t column, std::uint64_t at, std::uint64_t count, std::int64_t type,
                          const void* values) {
  const Opened& opened = columns_[column];
  const hsize_t first = at, size = count, end = at + count;
  check(opened.column.rows > 0 || H5Dset_extent(opened.set, &end) >= 0);
  const Hdf5Handle to(H5Dget_space(opened.set), H5Sclose),
      from(H5Screate_simple(1, &size, nullptr), H5Sclose);
  check(H5Sselect_hyperslab(to, H5S_SELECT_SET, &first, nullptr, &size, nullptr) >= 0 &&
        H5Dwrite(opened.set, type, from, to, H5P_DEFAULT, values) >= 0);
}

void Hdf5File::write(std::size_t column, std::uint64_t at, const std::vector<double>& values) {
  if (columns_[column].column.meanings.empty())
    return write_rows(column, at, values.size(), H5T_NATIVE_DOUBLE, values.data());
  std::vector<std::int8_t> numbers;
  for (const double value : values) numbers.push_back(static_cast<std::int8_t>(value));
  write_rows(column, at, numbers.size(), columns_[column].type, numbers.data());
}

void Hdf5File::write(std::size_t column, std::uint64_t at, const std::vector<std::string>& texts) {
  const std::size_t size = columns_[column].column.text_size;
  std::string bytes;
  for (const std::string& text : texts) {
    bytes += text.substr(0, size);
    bytes.append(size - std::min(size, text.size()), '\0');
  }
  write_rows(column, at, texts.size(), columns_[column].type, bytes.data());
}

void Hdf5File::close() {
  for (Opened& column : columns_) check(column.set.close());
  columns_.clear();
  check(H5Fflush(file_, H5F_SCOPE_LOCAL) >= 0);
  check(H5Fclose(std::exchange(file_, -1)) >= 0);
}

void Hdf5File::check(bool good) const {
  if (good) return;
  std::string reason = "HDF5 failed";
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* error, void* text) -> herr_t {
        if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(text) = error->desc;
        return 0;
      },
      &reason);
  // Take the message out of "file write failed: ..., errno = 28, error message = 'No space left on device',
  // ...".
  const std::string marker = "error message = '";
  if (const std::size_t at = reason.find(marker); at != std::string::npos)
    reason = reason.substr(at + marker.size(), reason.find('\'', at + marker.size()) - at - marker.size());
  throw OutputError("cannot write " + path_ + ": " + reason);
}

std::optional<std::string> why_no_hdf5(const std::vector<std::string>& names) {
  std::map<std::string, std::string> column_at;  // by the path that HDF5 makes of a name, without empty parts
  for (const std::string& name : names) {
    std::vector<std::string> parts = split(name, '/');
    std::erase(parts, "");
    const auto [other, added] = column_at.emplace(join(parts, "/"), name);
    if (!added)
      return "'" + other->second + "' and '" + name +
             "' are one path in HDF5, where a '/' makes groups: rename one of them";
  }
  for (const auto& [path, name] : column_at)
    for (std::size_t end = path.find('/'); end != path.npos; end = path.find('/', end + 1))
      if (const auto group = column_at.find(path.substr(0, end)); group != column_at.end())
        return "'" + group->second + "' would be the group of '" + name +
               "' in HDF5, where a '/' makes groups: rename one of them";
  return {};
}

std::optional<std::string> hdf5_text(const std::string& path, const std::string& name) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(path, none)) return {};
  const Hdf5Handle file = opened_to_read(path);
  if (file < 0 || H5Aexists(file, name.c_str()) <= 0) return {};
  const Hdf5Handle attribute(H5Aopen(file, name.c_str(), H5P_DEFAULT), H5Aclose),
      type = text_type(H5T_VARIABLE);
  char* characters = nullptr;
  if (attribute < 0 || H5Aread(attribute, type, &characters) < 0 || characters == nullptr) return {};
  std::string text = characters;
  H5free_memory(characters);
  return text;
}

std::vector<double> hdf5_numbers(const std::string& path, const std::string& column,
                                 const std::vector<std::uint64_t>& rows) {
  std::vector<double> values(rows.size());
  if (rows.empty()) return values;
  const Hdf5Handle file = opened_to_read(path);
  const Hdf5Handle set(file < 0 ? -1 : H5Dopen2(file, column.c_str(), H5P_DEFAULT), H5Dclose);
  const Hdf5Handle from(set < 0 ? -1 : H5Dget_space(set), H5Sclose);
  const hsize_t count = rows.size();
  const Hdf5Handle to(H5Screate_simple(1, &count, nullptr), H5Sclose);
  const std::vector<hsize_t> places(rows.begin(), rows.end());
  const bool all = from >= 0 && H5Sget_simple_extent_npoints(from) == static_cast<hssize_t>(rows.size());
  if (from < 0 || (!all && H5Sselect_elements(from, H5S_SELECT_SET, places.size(), places.data()) < 0) ||
      H5Dread(set, H5T_NATIVE_DOUBLE, to, from, H5P_DEFAULT, values.data()) < 0)
    throw OutputError("cannot read " + column + " of " + path);
  return values;
}

}  // namespace drev::app
