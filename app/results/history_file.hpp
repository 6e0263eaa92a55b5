#pragma once
/// history.csv: time_s and the recorded channels, one row at each time k * every, k = 0, 1, 2, ...; 17
/// significant digits, from which every double is read back exactly. Names are written by csv_cell().
#include <string>
#include <vector>

#include "app/results/row_file.hpp"

namespace drev::app {

class HistoryFile : public RowFile {
 public:
  /// Opens the file and writes its header. Throws OutputError.
  HistoryFile(const std::string& directory, const std::vector<std::string>& channels, double every);

  /// Adds the next row.
  void add(const std::vector<double>& row);

 private:
  double every_;
  std::string line_;
};

}  // namespace drev::app
