#pragma once
/// A shaft contour as bodies of revolution and sections. Internal to shaft_contour.hpp.
#include <drev/models/shafts/shaft_contour.hpp>

#include <utility>

#include "models/shafts/revolved_body.hpp"
#include "models/shafts/section_torsion.hpp"

namespace drev {

/// Outlines of a station's features; throw ModelError for dimensions that cannot be.
SectionOutline keyway_of(const ShaftStation& station);
SectionOutline spline_of(const ShaftStation& station);
SectionOutline cam_of(const ShaftStation& station);
double groove_half_width(const ShaftGroove& groove);
/// Segments of each station; throws ModelError where they are too many.
std::vector<int> segment_counts(const ShaftContour& contour);

/// likely: cams and splines as the circle of their J, hubs as one with the shaft. soft, stiff: bounds.
enum class ContourVariant { likely, soft, stiff };

/// The section of a station that is not round, in two dimensions.
struct StationSection {
  bool round = true;
  SectionTorsion torsion;          ///< of a section that is not round; bore deducted
  double least = 0.0, most = 0.0;  ///< radii of the inscribed and circumscribed circles about the axis
};
/// Of all stations; stations of one section share its solution.
std::vector<StationSection> station_sections(const ShaftContour& contour);
/// ShaftContour::check(), which gives the sections that it has found on its way.
std::vector<StationSection> check_contour(const ShaftContour& contour, ParameterCheck& check);

class ContourParts {
 public:
  ContourParts(const ShaftContour& contour, const std::vector<StationSection>& sections,
               ContourVariant variant);
  /// Pieces from left to right; a groove divides its station in three.
  const std::vector<RevolvedStation>& pieces() const { return pieces_; }
  const std::vector<int>& station() const { return station_; }  ///< of each piece
  /// Outer radii at the two ends of a station.
  std::pair<double, double> radii(std::size_t station) const;
  struct Slice {
    double radius, bore, factor;  ///< of the body of revolution, fillets and grooves with it; factor of its J
  };
  Slice section_at(double z) const;
  /// int r^2 dA of the section at z [m^4].
  double polar(double z) const;

 private:
  /// The piece at z, which becomes the distance from its left end.
  std::size_t piece_at(double& z) const;
  const std::vector<StationSection>& sections_;
  std::vector<RevolvedStation> pieces_;
  std::vector<int> station_;
};

}  // namespace drev
