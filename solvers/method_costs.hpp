#pragma once
/// What steps cost beside each other, for the choice of a method and its trial: measured on chains of 2 to 1000 unknowns,
/// where a product costs 1.2 to 3.2 ns times unknowns and contacts.

namespace drev {

/// Products in a step of exact propagation: 24 were measured in a step of 3/omega, as many more for each contact change,
/// which no one knows before.
inline constexpr double kProductsInStep = 25.0;
/// What the 7 evaluations of a step of dormand_prince cost, about 10 products each. Where the fastest modes are excited,
/// accuracy bounds its steps instead.
inline constexpr double kProductsOfStages = 70.0;
inline constexpr double kUnknownsOfStep = 20.0;     ///< what a step costs beside its products, as unknowns
inline constexpr double kUnknownsOfContact = 10.0;  ///< what a contact costs, as unknowns

}  // namespace drev
