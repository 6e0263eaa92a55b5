#pragma once
/// Every element of the catalogue.
#include <drev/elements/applied_torque.hpp>
#include <drev/elements/cam_torque.hpp>
#include <drev/elements/dashpot.hpp>
#include <drev/elements/distributed_shaft.hpp>
#include <drev/elements/engine_order_torque.hpp>
#include <drev/elements/gear_mesh.hpp>
#include <drev/elements/ground_spring.hpp>
#include <drev/elements/ideal_gear.hpp>
#include <drev/elements/inertia.hpp>
#include <drev/elements/involute.hpp>
#include <drev/elements/polyline_spring.hpp>
#include <drev/elements/rayleigh_damping.hpp>
#include <drev/elements/segment_count.hpp>
#include <drev/elements/shaft_spring.hpp>
