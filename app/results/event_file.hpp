#pragma once
/// The contact events of a run as a CSV file (--events): one row each, in the order of time.
///
///   time_s,element,flank,contact,rate,rate_unit
///   0.00132914,mesh_1,front,lost,-0.00071,m/s
///
///   0.8301047,clutch,,stuck,0,rad/s
///
/// flank: front or back; contact: made or lost; of dry friction, without a flank: stuck, sliding forward, sliding backward
/// or open, of a freewheel locked or released, of a lossy gear stuck, turning forward or turning backward. rate: of the deflection, positive towards the front flank, m/s along the
/// line of action or rad/s; of friction the slip speed. 17 significant digits, element names as csv_cell() has them.
#include <drev/solvers/run/contact_statistics.hpp>

#include <string>
#include <vector>

#include "app/results/row_file.hpp"

namespace drev::app {

class EventFile : public RowFile {
 public:
  /// Opens the file, NAME.csv, and writes its header. Throws OutputError.
  explicit EventFile(const std::string& path);

  /// The system whose laws the events are of. Before the first event.
  void follow(const System& system);
  /// The next row.
  void add(const ContactEvent& event);

 private:
  struct Law {
    std::string element, rate_unit;
  };
  std::vector<Law> laws_, frictions_;
  std::vector<const Friction*> friction_laws_;
};

}  // namespace drev::app
