#pragma once
/// Fields that several elements have, and those of the gear mesh.
#include <drev/app/model_file/fields.hpp>
#include <drev/elements/gear_mesh.hpp>

namespace drev::app {

/// Columns order (or frequency), amplitude and, if wanted, phase; true where they were given.
bool list_harmonics(Fields& f, const char* name, const Quantity& order, const Quantity& amplitude,
                    std::vector<Harmonic>& harmonics);

/// A table over one period; true where it was given. A last point one period after the first that repeats its
/// value is left out.
bool list_periodic(Fields& f, const char* name, const Quantity& argument, const Quantity& value,
                   double period, PeriodicTable& table);

void list(Fields& f, GearMesh::Params& p);

}  // namespace drev::app
