#pragma once
/// What an element of one's own is made of (docs/adding_an_element.md), from the short way to the long one:
///
///   a law       LawElement (law_element.hpp): force of a deflection and its rate, one formula
///   a torque    LoadElement (load_element.hpp): torque on a node, one formula
///   an element  derived from Element (element_interface.hpp), whose describe() states Terms (element.hpp):
///               matrices, laws (LawForce, ScalarForce), loads (Load), rows that hold exactly
///
/// Terms of rarer kinds have headers of their own: dry friction (core/law/friction.hpp), forces over several
/// nodes with a history (core/general_force.hpp). check_element() of core/verify.hpp tries an element.
#include <drev/core/element.hpp>
#include <drev/core/law/load_element.hpp>
#include <drev/core/law_element.hpp>
#include <drev/elements/not_given.hpp>
