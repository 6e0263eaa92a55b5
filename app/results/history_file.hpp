#pragma once
/// history.csv: time_s and the recorded channels, one row each at k * every, k = 0, 1, 2, ...; 17
/// significant digits, with which every double reads back as it was. Names as csv_cell() has them.
#include <string>
#include <vector>

#include "app/results/row_file.hpp"

namespace drev::app {

class HistoryFile : public RowFile {
 public:
  /// Opens the file and writes its header. Throws OutputError.
  HistoryFile(const std::string& directory, const std::vector<std::string>& channels, double every);

  /// The next row.
  void add(const std::vector<double>& row);

 private:
  double every_;
  std::string line_;
};

}  // namespace drev::app
