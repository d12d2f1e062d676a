#pragma once

#include <memory>
#include <vector>

#include "ebac/gastroscope/params.hpp"
#include "ebac/gastroscope/vec.hpp"

namespace ebac::world {
class Solid;
}

namespace ebac::gastroscope {

/// Where the parts of the lumen end, along its centre line [m].
struct Landmarks {
  double oesophagus = 0, cardia = 0, stomach = 0, pylorus = 0, behind = 0, end = 0;
};

/// How the whole lumen is displaced at an instant.
struct LumenMotion {
  double t = 0;  // s
  Vec bag{};     // m, of the stomach, pushed by the instrument
};

/// Where along the centre line a point was last: between two stations, 5 mm apart where the lumen
/// is made from measures.
struct Along {
  int station = 0;
  double share = 0;  // of the way to the next one
};

/// The wall near a point.
struct WallNear {
  double s = 0;      // m, along the centre line
  double depth = 0;  // m, of a ball about the point in the wall; negative: free
  Vec way{};         // gradient of the depth: where the wall yields to
  double moves = 0;  // share of the bag's displacement here, 0 to 1
};

/// The way from the teeth to behind the pylorus: a centre line with a radius, and a wall that moves
/// with peristalsis and breathing; or the wall of a solid given by the user.
class Lumen {
 public:
  /// From measures alone.
  explicit Lumen(const PatientParams& params);

  /// Along points 5 mm or more apart, with a radius each; `wall`, where given, is the tissue. It has
  /// the landmarks of `params` and ends with the points. Throws std::invalid_argument for fewer than
  /// two points or less than a radius each.
  Lumen(const PatientParams& params, const std::vector<Vec>& points,
        const std::vector<double>& radii, std::shared_ptr<const world::Solid> wall);

  /// The wall near a ball of `radius` [m] about `x`; `hint` is the place of the last answer.
  WallNear near(const Vec& x, double radius, const LumenMotion& motion, Along& hint) const EBAC_RT;

  /// Centre line at `s` [m], displaced by the motion.
  Vec middle(double s, const LumenMotion& motion) const EBAC_RT;
  Frame frame(double s) const EBAC_RT;
  double radius(double s, double t) const EBAC_RT;

  const Landmarks& landmarks() const EBAC_RT { return landmarks_; }
  const PatientParams& params() const EBAC_RT { return params_; }

 private:
  static constexpr double kStep = 5e-3;  // m, from station to station

  struct Station {
    Vec at{};
    Frame frame{};
    Vec ahead{};          // of the segment to the next one
    Vec along{};          // square to the section of the lumen here, between both segments
    double length = 0;    // m, of that segment
    double radius = 0;    // m
    double widens = 0;    // of the radius along the centre line
    double breathes = 0;  // share of the diaphragm's motion
    double s = 0;         // m
  };

  struct Spot {
    std::size_t station;
    double share;
  };
  /// Radius at rest and how it widens over a segment.
  struct Width {
    double radius, slope;
  };
  Spot spot(double s) const EBAC_RT;
  Width width(const Spot& at) const EBAC_RT;
  int segment(const Vec& x, int first) const EBAC_RT;
  void finish();
  Vec shift(double breathes, double moves, const LumenMotion& motion) const EBAC_RT;
  double moves(double s) const EBAC_RT;
  double wave(double s, double t) const EBAC_RT;

  PatientParams params_;
  Landmarks landmarks_;
  std::vector<Station> stations_;
  std::shared_ptr<const world::Solid> wall_;
  Vec down_{0, 0, -1};  // the way of the diaphragm
};

}  // namespace ebac::gastroscope
