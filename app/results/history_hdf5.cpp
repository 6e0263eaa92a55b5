#include "app/results/history_hdf5.hpp"

#include <drev/core/version.hpp>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "app/base/output_file.hpp"
#include "app/results/hdf5_file.hpp"

namespace drev::app {

namespace {

constexpr std::size_t kBlock = 1024;  // rows

}  // namespace

void write_hdf5(const std::string& directory, const std::string& csv,
                const std::vector<HistoryColumn>& columns, const std::string& summary) {
  std::ifstream in(csv);
  std::string line;
  if (!std::getline(in, line)) throw OutputError("cannot read " + csv + ": " + std::strerror(errno));
  OutputFile file(directory, "history", "h5");
  {
    Hdf5File h5(file.partial_path());
    h5.add_text("drev", DREV_VERSION);
    h5.add_text("summary", summary);
    h5.add_column({"time_s", "s"});
    for (const HistoryColumn& column : columns) h5.add_column({column.name, column.unit});
    std::vector<std::vector<double>> block(columns.size() + 1);
    std::uint64_t rows = 0;
    const auto empty_block = [&] {
      if (block[0].empty()) return;
      for (std::size_t c = 0; c < block.size(); ++c) h5.write(c, rows, block[c]);
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
