#pragma once
/// Results as HDF5. history.h5: history.csv as HDF5, made from it when the run is complete. A dataset time_s
/// and one for each channel, by its name, with the attribute "unit"; the file's attributes are "drev"
/// (version) and "summary" (summary.json as text).
#include <string>
#include <vector>

namespace drev::app {

struct HistoryColumn {
  std::string name, unit;
};

/// csv: path of a complete history.csv with the columns time_s and these. Writes DIRECTORY/history.h5, which
/// remains unchanged if that fails. Throws OutputError.
void write_hdf5(const std::string& directory, const std::string& csv,
                const std::vector<HistoryColumn>& columns, const std::string& summary);

/// A table that is written into one file with others: its text as CSV, with the header in the first line.
struct TableText {
  std::string name, csv;
};
/// PATH: a group for each table, in it a dataset for each column by its name, of numbers (an empty cell: not a
/// number), or of texts where a cell is neither. The file's attributes are those of history.h5. A file that
/// exists at the path remains unchanged if that fails. Throws OutputError.
void write_tables_hdf5(const std::string& path, const std::vector<TableText>& tables,
                       const std::string& summary);

}  // namespace drev::app
