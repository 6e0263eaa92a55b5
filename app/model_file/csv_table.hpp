#pragma once
/// A table of numbers in a CSV file (RFC 4180, with or without a byte-order mark): a header of column names, then
/// rows. Lines that are empty or begin with '#' are passed over. A name that begins with = + - @ may have a ' before
/// it, which is not part of it.
#include <string>
#include <vector>

#include "app/model_file/tree.hpp"

namespace drev::app {

struct CsvTable {
  std::vector<std::string> names;
  std::vector<std::vector<double>> columns;
};

/// Throws ModelError with every fault, by line and column of the CSV file; one that cannot be read is blamed
/// on the place that names it.
CsvTable read_csv(const std::string& path, const Position& named_at);

}  // namespace drev::app
