#pragma once
/// The contact events of a run as a CSV file (--events): one row for each event, in the order of time.
///
///   time_s,element,flank,contact,rate,rate_unit
///   0.00132914,mesh_1,front,lost,-0.00071,m/s
///
///   0.8301047,clutch,,stuck,0,rad/s
///
/// flank: front or back; contact: made or lost. Without a flank, contact is, for dry friction: stuck, sliding
/// forward, sliding backward or open; for a freewheel: locked or released; for a lossy gear: stuck, turning
/// forward or turning backward. rate: rate of the deflection, positive towards the front flank, in m/s along
/// the line of action or in rad/s; for friction the slip speed. Numbers have 17 significant digits; element
/// names are written by csv_cell().
#include <drev/solvers/run/contact_statistics.hpp>

#include <string>
#include <vector>

#include "app/results/row_file.hpp"

namespace drev::app {

class EventFile : public RowFile {
 public:
  /// Opens the file, NAME.csv, and writes its header. Throws OutputError.
  explicit EventFile(const std::string& path);

  /// Sets the system whose laws the events belong to. To be called before the first event.
  void follow(const System& system);
  /// Adds the next row.
  void add(const ContactEvent& event);

 private:
  struct Law {
    std::string element, rate_unit;
  };
  std::vector<Law> laws_, frictions_;
  std::vector<const Friction*> friction_laws_;
};

}  // namespace drev::app
