#pragma once

#include <string>

#include "ebac/control/any_law.hpp"
#include "values.hpp"

namespace ebac::python {

/// A Python class under construction for one type of law.
struct LawClass {
  py::object cls;
  const LawType* type;
  std::string owner;  // "EBAC"
  std::string full;   // "ebac._core.EBAC"

  /// A method whose docstring begins with `signature`, "(self, port: Port) -> float"; in it and in
  /// `what`, LAW stands for the class.
  template <class Function, class... Extra>
  void def(const char* name, Function function, const std::string& signature, const char* what,
           const Extra&... extra) const {
    add_method(cls, name, std::move(function), documented(name, signature, what), extra...);
  }
  template <class Function, class... Extra>
  void def_static(const char* name, Function function, const std::string& signature,
                  const char* what, const Extra&... extra) const {
    add_static(cls, name, std::move(function), documented(name, signature, what), extra...);
  }

 private:
  std::string documented(const char* name, const std::string& signature, const char* what) const;
};

/// Simulation, replay, sweeps, benchmarks.
void add_runs(const LawClass& law);
/// The loop of real time over drives.
void add_start(const LawClass& law);

}  // namespace ebac::python
