#include "others_run.hpp"

#include <chrono>

#include "bind.hpp"

namespace ebac::python {

namespace py = pybind11;

namespace {

constexpr std::chrono::microseconds kLook{200};
constexpr int kMostLooks = 5000;  // a second

}  // namespace

std::atomic<bool> Leaving::leaving{false};
std::atomic<int> Leaving::entering{0};
std::thread::id Leaving::leaver;

void Leaving::leave() {
  leaver = std::this_thread::get_id();
  leaving.store(true);
  const OthersRun others_run;
  for (int i = 0; i < kMostLooks && entering.load() > 0; ++i) std::this_thread::sleep_for(kLook);
}

void Leaving::stay() {
  done();
  while (true) std::this_thread::sleep_for(std::chrono::hours(1));
}

void bind_leaving() {
  py::module_::import("atexit").attr("register")(py::cpp_function(&Leaving::leave));
}

}  // namespace ebac::python
