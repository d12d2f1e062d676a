#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>

#include "bind.hpp"
#include "ebac/identify/arm_record.hpp"
#include "others_run.hpp"

namespace ebac::python {

namespace py = pybind11;

namespace {

using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::span<const double> theta_of(const ArmRecord& record, const Numbers& theta) {
  const auto size = static_cast<std::size_t>(theta.size());
  if (size != record.parameters()) {
    throw std::invalid_argument("ArmRecord: theta has " + std::to_string(size) +
                                " numbers, needs " + std::to_string(record.parameters()));
  }
  const std::span<const double> view(theta.data(), size);
  if (!(view[0] > 0)) throw std::invalid_argument("ArmRecord: the mass must be positive");
  return view;
}

std::vector<double> list_of(const Numbers& column) {
  return {column.data(), column.data() + column.size()};
}

py::array_t<double> rows_of(const ArmRecord& record) {
  return py::array_t<double>(static_cast<py::ssize_t>(record.rows()));
}

/// Errors and their derivatives along some parameters, with room for some rows behind them: zeros.
struct Derivatives {
  Derivatives(const ArmRecord& record, std::size_t parameters, std::size_t more)
      : stride(record.rows() + more),
        errors(static_cast<py::ssize_t>(stride)),
        columns({parameters, stride}),
        errors_view(errors.mutable_data(), stride),
        columns_view(columns.mutable_data(), parameters * stride) {
    std::fill(errors_view.end() - static_cast<std::ptrdiff_t>(more), errors_view.end(), 0.0);
    for (std::size_t k = 1; k <= parameters; ++k) {
      std::fill_n(columns_view.begin() + static_cast<std::ptrdiff_t>(k * stride - more), more, 0.0);
    }
  }

  std::size_t stride;
  py::array_t<double> errors, columns;
  std::span<double> errors_view, columns_view;
};

ArmRecord::Noise noise_of(const std::array<double, 3>& noise) {
  if (std::all_of(noise.begin(), noise.end(), [](double size) { return size >= 0; })) {
    return {noise[0], noise[1], noise[2]};
  }
  throw std::invalid_argument("ArmRecord: force_noise, drift or offset is negative");
}

ArmGains gains(const ArmRecord& record, const Numbers& theta, double force_noise, double drift,
               double offset) {
  const auto view = theta_of(record, theta);
  const ArmRecord::Noise noise = noise_of({force_noise, drift, offset});
  const OthersRun release;
  return record.gains(ArmGuess::from(view, record.inputs()), noise);
}

void require_same(const ArmRecord& record, const ArmGains& gains) {
  if (gains.rows.size() == record.rows()) return;
  throw std::invalid_argument("ArmRecord: the gains belong to another record");
}

py::array_t<double> innovations(const ArmRecord& record, const Numbers& theta,
                                const ArmGains& gains) {
  const auto view = theta_of(record, theta);
  require_same(record, gains);
  auto out = rows_of(record);
  const std::span<double> errors(out.mutable_data(), record.rows());
  {
    const OthersRun release;
    record.innovations(ArmGuess::from(view, record.inputs()), gains, errors);
  }
  return out;
}

/// Rows of a matrix, one vector of parameters each.
std::vector<std::span<const double>> thetas_of(const ArmRecord& record, const Numbers& thetas) {
  if (thetas.ndim() != 2 || static_cast<std::size_t>(thetas.shape(1)) != record.parameters()) {
    throw std::invalid_argument("ArmRecord: needs the shape (trials, " +
                                std::to_string(record.parameters()) + ")");
  }
  std::vector<std::span<const double>> out;
  for (py::ssize_t i = 0; i < thetas.shape(0); ++i) {
    out.emplace_back(thetas.data(i, 0), record.parameters());
    if (!(out.back()[0] > 0)) throw std::invalid_argument("ArmRecord: the mass must be positive");
  }
  return out;
}

py::array_t<double> judge(const ArmRecord& record, const Numbers& thetas, const Numbers& helds,
                          const std::vector<std::array<double, 3>>& noises, double robust) {
  const auto views = thetas_of(record, thetas);
  const auto made = thetas_of(record, helds);
  if (views.size() != made.size() || views.size() != noises.size()) {
    throw std::invalid_argument("ArmRecord: needs a theta, a held and a noise for each trial");
  }
  std::vector<ArmRecord::Trial> trials;
  trials.reserve(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    trials.push_back({ArmGuess::from(views[i], record.inputs()),
                      ArmGuess::from(made[i], record.inputs()), noise_of(noises[i])});
  }
  py::array_t<double> out(static_cast<py::ssize_t>(trials.size()));
  const std::span<double> costs(out.mutable_data(), trials.size());
  {
    const OthersRun release;
    record.judge(trials, robust, costs);
  }
  return out;
}

py::array_t<double> drifts(const ArmRecord& record, const Numbers& theta, const ArmGains& gains) {
  const auto view = theta_of(record, theta);
  require_same(record, gains);
  auto errors = rows_of(record);
  auto out = rows_of(record);
  const std::span<double> left(errors.mutable_data(), record.rows());
  const std::span<double> drift(out.mutable_data(), record.rows());
  {
    const OthersRun release;
    record.innovations(ArmGuess::from(view, record.inputs()), gains, left, drift);
  }
  return out;
}

void require_known(std::size_t parameters, const std::vector<std::size_t>& which) {
  for (const std::size_t index : which) {
    if (index >= parameters) throw std::invalid_argument("ArmRecord: no such parameter");
  }
}

void require_steps(const std::vector<std::size_t>& which, const std::vector<double>& steps) {
  if (which.size() != steps.size()) {
    throw std::invalid_argument("ArmRecord: needs one step for each parameter");
  }
  for (const double step : steps) {
    if (!(step > 0)) throw std::invalid_argument("ArmRecord: a step is not positive");
  }
}

std::pair<py::array_t<double>, py::array_t<double>> linearised(
    const ArmRecord& record, const Numbers& theta, const ArmGains& gains,
    const std::vector<std::size_t>& which, std::size_t more) {
  const auto view = theta_of(record, theta);
  require_same(record, gains);
  require_known(view.size(), which);
  Derivatives out(record, which.size(), more);
  {
    const OthersRun release;
    record.linearised(view, gains, which, out.errors_view, out.columns_view, out.stride);
  }
  return {out.errors, out.columns};
}

std::pair<py::array_t<double>, py::array_t<double>> renewed(
    const ArmRecord& record, const Numbers& theta, const Numbers& held, std::array<double, 3> noise,
    const std::vector<std::size_t>& which, std::size_t kept, const std::vector<double>& steps,
    std::size_t more) {
  const auto view = theta_of(record, theta);
  const auto made = theta_of(record, held);
  require_known(view.size(), which);
  require_steps(which, steps);
  const ArmRecord::Noise size = noise_of(noise);
  Derivatives out(record, which.size(), more);
  {
    const OthersRun release;
    record.renewed(view, made, size, which, kept, steps, out.errors_view, out.columns_view,
                   out.stride);
  }
  return {out.errors, out.columns};
}

py::array_t<double> simulate(const ArmRecord& record, const Numbers& theta, double x, double v) {
  const auto view = theta_of(record, theta);
  auto out = rows_of(record);
  const std::span<double> positions(out.mutable_data(), record.rows());
  {
    const OthersRun release;
    record.simulate(ArmGuess::from(view, record.inputs()), x, v, positions);
  }
  return out;
}

}  // namespace

void bind_identify(py::module_& m) {
  py::class_<ArmGains>(m, "ArmGains",
                       "Kalman gains: correction of the prediction of eq. (4) by each row.")
      .def_property_readonly(
          "log_sum", [](const ArmGains& gains) { return gains.log_sum; },
          "Sum of the logarithms of the variances of the errors.");
  py::class_<ArmRecord>(m, "ArmRecord",
                        "A log of one hand, and its prediction by eq. (4).\n\n"
                        "theta: mass [kg], damping [N s/m], stiffness [N/m], delay [s], onset "
                        "[s], bend [1], a share for each input, then the levels of the target [m].")
      .def(py::init([](const Numbers& x, const Numbers& force, const Numbers& variance,
                       const Numbers& early, const Numbers& known, const Numbers& doubt,
                       const std::vector<Numbers>& inputs, std::vector<double> switches,
                       std::vector<int> segments, double dt, double lag) {
             std::vector<std::vector<double>> columns;
             columns.reserve(inputs.size());
             for (const Numbers& input : inputs) columns.push_back(list_of(input));
             return ArmRecord({list_of(x), list_of(force), list_of(variance), list_of(early),
                               list_of(known), list_of(doubt), std::move(columns),
                               std::move(switches), std::move(segments), dt, lag});
           }),
           py::kw_only(), py::arg("x"), py::arg("force"), py::arg("variance"), py::arg("early"),
           py::arg("known"), py::arg("doubt"), py::arg("inputs"), py::arg("switches"),
           py::arg("segments"), py::arg("dt"), py::arg("lag"))
      .def_property_readonly("parameters", &ArmRecord::parameters, "Length of theta.")
      .def(
          "resting",
          [](const ArmRecord& record, const Numbers& noise) {
            return record.resting(list_of(noise));
          },
          py::arg("noise"),
          "Return the same log of a hand at rest in its place, whose force is but `noise` [N], "
          "shape "
          "(rows,).")
      .def("gains", &gains, py::arg("theta"), py::arg("force_noise"), py::arg("drift") = 0.0,
           py::arg("offset") = 0.0,
           "Return the gains for theta and force readings of standard deviation `force_noise` [N] "
           "that drift by a random walk of `drift` [N/sqrt(s)] from within `offset` [N].")
      .def("drifts", &drifts, py::arg("theta"), py::arg("gains"),
           "Return by how much the force reads too high at each row [N], shape (rows,).")
      .def("innovations", &innovations, py::arg("theta"), py::arg("gains"),
           "Return the one-step prediction errors, each divided by its standard deviation.")
      .def("judge", &judge, py::arg("theta"), py::arg("held"), py::arg("noise"),
           py::arg("robust") = 0.0,
           "Return -2 log of the likelihood of each of some trials, but for a constant, shape "
           "(trials,): of theta, shape (trials, parameters), with the gains made for `held`, of "
           "the same shape, and `noise` as of `gains`, one of three each. Errors beyond `robust` "
           "deviations count linearly, 0 for none.")
      .def("linearised", &linearised, py::arg("theta"), py::arg("gains"), py::arg("which"),
           py::arg("more") = 0,
           "Return the innovations, shape (rows,), and d innovations / d theta[which], shape "
           "(which, rows), exact; with `more` rows of zeros behind them.")
      .def("renewed", &renewed, py::arg("theta"), py::arg("held"), py::arg("noise"),
           py::arg("which"), py::arg("kept"), py::arg("steps"), py::arg("more") = 0,
           "Return the same as `linearised`, with the gains made anew for each change, of theta "
           "and but for the last `kept` of `held`, by differences of `steps`; `noise` as of "
           "`gains`.")
      .def(
          "simulate", &simulate, py::arg("theta"), py::arg("x"), py::arg("v"),
          "Return the position [m] simulated from a state [m, m/s] with the recorded force alone.");
}

}  // namespace ebac::python
