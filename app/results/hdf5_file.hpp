#pragma once
/// An HDF5 file of columns: datasets of one dimension, with their unit as an attribute. The same columns give the
/// same bytes, since no time stamps are stored.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace drev::app {

class Hdf5File {
 public:
  /// Writes the file at path, which an OutputFile holds open. Throws OutputError, like the other functions.
  explicit Hdf5File(const std::string& path);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Adds a text attribute of the file.
  void add_text(const std::string& name, const std::string& text);

  /// Columns have the numbers 0, 1, ... A name with a slash is in a group.
  struct Column {
    std::string name, unit = {};
    std::uint64_t rows = 0;     ///< number of rows; 0: the column grows
    std::size_t text_size = 0;  ///< bytes of each text in a column of texts; 0: a column of numbers
    /// Meanings of the integers 0, 1, ... in the column; empty: the numbers have no meanings.
    std::vector<std::string> meanings = {};
  };
  void add_column(const Column& column);
  void write(std::size_t column, std::uint64_t at, const std::vector<double>& values);
  void write(std::size_t column, std::uint64_t at, const std::vector<std::string>& texts);

  void close();

 private:
  struct Opened;
  void add_text_to(std::int64_t object, const char* name, const std::string& text);
  void write_rows(std::size_t column, std::uint64_t at, std::uint64_t count, std::int64_t type,
                  const void* values);
  void check(bool good) const;

  std::string path_;
  std::int64_t file_ = -1;
  std::vector<Opened> columns_;
};

/// Why columns of these names cannot all have a dataset; nullopt: they can.
std::optional<std::string> why_no_hdf5(const std::vector<std::string>& names);

/// A text attribute of an HDF5 file; nullopt: there is no such file or attribute.
std::optional<std::string> hdf5_text(const std::string& path, const std::string& name);

/// The given rows of a column of numbers, or of the integers of a column with meanings; `rows` must ascend.
/// Throws OutputError where they cannot be read.
std::vector<double> hdf5_numbers(const std::string& path, const std::string& column,
                                 const std::vector<std::uint64_t>& rows);

}  // namespace drev::app
