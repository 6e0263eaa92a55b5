#pragma once
/// Fields that several elements have, and those of the gear mesh and of engines, couplings, machines and gear sets.
#include <drev/app/model_file/fields.hpp>
#include <drev/elements/couplings/absolute_damper.hpp>
#include <drev/elements/couplings/elastic_coupling.hpp>
#include <drev/elements/couplings/torsional_damper.hpp>
#include <drev/elements/engine/engine_cylinders.hpp>
#include <drev/elements/friction/dry_friction.hpp>
#include <drev/elements/friction/freewheel.hpp>
#include <drev/elements/friction/lossy_gear.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/elements/gears/planetary_set.hpp>
#include <drev/elements/machines/generator.hpp>
#include <drev/elements/machines/propeller.hpp>
#include <drev/elements/machines/speed_governor.hpp>
#include <drev/elements/machines/torque_curve.hpp>
#include <drev/elements/machines/torque_function.hpp>
#include <drev/elements/periodic_curve.hpp>
#include <drev/models/shafts/shaft_contour.hpp>

namespace drev {
struct GearDrawing;
}

namespace drev::app {

/// Columns order (or frequency), amplitude and, if wanted, phase; true where they were given.
bool list_harmonics(Fields& f, const char* name, const Quantity& order, const Quantity& amplitude,
                    std::vector<Harmonic>& harmonics);

/// A table over one period; true where it was given. A last point one period after the first that repeats its
/// value is left out.
bool list_periodic(Fields& f, const char* name, const Quantity& argument, const Quantity& value,
                   double period, PeriodicTable& table);

/// linear or cubic between the points of a table.
void list_interpolation(Fields& f, Interpolation& interpolation);

/// The drawing of a gear pair: `geometry` of a gear mesh, or of a file of drev gear (docs/gears.md).
void list(Fields& f, GearDrawing& drawing);
void list(Fields& f, GearMesh::Params& p);
void list(Fields& f, EngineCylinders::Params& p);
void list(Fields& f, ElasticCoupling::Params& p);
void list(Fields& f, TorsionalDamper::Params& p);
void list(Fields& f, AbsoluteDamper::Params& p);
void list(Fields& f, Propeller::Params& p);
void list(Fields& f, TorqueCurve::Params& p);
void list(Fields& f, TorqueFunction::Params& p);
void list(Fields& f, Generator::Params& p);
void list(Fields& f, SpeedGovernor::Params& p);
void list(Fields& f, PlanetarySet::Params& p);
void list(Fields& f, ShaftContour& p);
void list(Fields& f, DryFriction::Params& p);
void list(Fields& f, Freewheel::Params& p);
void list(Fields& f, LossyGear::Params& p);

}  // namespace drev::app
