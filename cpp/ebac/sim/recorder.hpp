#pragma once

#include <vector>

#include "ebac/sim/contact.hpp"

namespace ebac {

/// Columns for one run, used again for the next: they grow to the longest run and stay.
class ContactRecorder {
 public:
  void start(std::size_t rows) {
    for (auto* column : {&t_, &x_, &force_, &energy_, &stored_, &clamped_, &pull_, &wall_}) {
      column->clear();
      column->reserve(rows);
    }
  }

  void add(double t, double x, double force, double energy, double stored) {
    t_.push_back(t);
    x_.push_back(x);
    force_.push_back(force);
    energy_.push_back(energy);
    stored_.push_back(stored);
  }
  void add_pull(double pull) { pull_.push_back(pull); }
  void add_wall(double wall) { wall_.push_back(wall); }
  void add_clamped(bool clamped) { clamped_.push_back(clamped ? 1.0 : 0.0); }

  std::size_t rows() const { return t_.size(); }

  ContactRecord record() const {
    return {.t = t_,
            .x = x_,
            .force = force_,
            .energy = energy_,
            .stored = stored_,
            .clamped = clamped_,
            .pull = pull_,
            .wall = wall_};
  }

 private:
  std::vector<double> t_, x_, force_, energy_, stored_, clamped_, pull_, wall_;
};

}  // namespace ebac
