#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "ebac/core/sample.hpp"
#include "ebac/sim/contact.hpp"

namespace ebac {

/// Columns for one run, used again for the next: they grow to the longest run and stay.
class ContactRecorder {
 public:
  void start(std::size_t rows, std::size_t axes = 1) {
    axes_ = axes;
    for (auto* column : {&t_, &energy_, &stored_}) begin(*column, rows);
    for (std::size_t i = 0; i < axes; ++i) {
      AxisColumns& of = axis_[i];
      for (auto* column : {&of.x, &of.force, &of.clamped, &of.pull, &of.wall}) begin(*column, rows);
    }
  }

  /// The next row; `energy` and `stored` [J] are those of all axes.
  void add(double t, double energy, double stored) {
    t_.push_back(t);
    energy_.push_back(energy);
    stored_.push_back(stored);
  }
  void add_axis(std::size_t axis, double x, double force) {
    axis_[axis].x.push_back(x);
    axis_[axis].force.push_back(force);
  }
  void add_world(std::size_t axis, double wall, double pull) {
    axis_[axis].wall.push_back(wall);
    axis_[axis].pull.push_back(pull);
  }
  void add_clamped(std::size_t axis, bool clamped) {
    axis_[axis].clamped.push_back(clamped ? 1.0 : 0.0);
  }

  std::size_t rows() const { return t_.size(); }
  std::size_t axes() const { return axes_; }

  ContactRecord record(std::size_t axis = 0) const {
    const AxisColumns& of = axis_[axis];
    return {.t = t_,
            .x = of.x,
            .force = of.force,
            .energy = energy_,
            .stored = stored_,
            .clamped = of.clamped,
            .pull = of.pull,
            .wall = of.wall};
  }

 private:
  struct AxisColumns {
    std::vector<double> x, force, clamped, pull, wall;
  };
  static void begin(std::vector<double>& column, std::size_t rows) {
    column.clear();
    column.reserve(rows);
  }

  std::size_t axes_ = 1;
  std::vector<double> t_, energy_, stored_;
  std::array<AxisColumns, kMaxAxes> axis_;
};

}  // namespace ebac
