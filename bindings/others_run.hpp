#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <thread>

namespace ebac::python {

/// How the interpreter ends. A thread that comes back to Python after that is ended by CPython in
/// the middle of its C++ frames, which aborts the process; here it waits for the end instead.
class Leaving {
 public:
  /// The last of the exit handlers: waits for threads that are coming back to Python, keeps all
  /// later ones.
  static void leave();
  /// Called without the interpreter's lock, before it is taken; `done` after that.
  static void enter() {
    entering.fetch_add(1);
    if (leaving.load() && std::this_thread::get_id() != leaver) stay();
  }
  static void done() { entering.fetch_sub(1); }

 private:
  [[noreturn]] static void stay();

  static std::atomic<bool> leaving;
  static std::atomic<int> entering;
  static std::thread::id leaver;  // ends the interpreter, and may come back
};

/// Gives the interpreter's lock away for a scope. Not `py::gil_scoped_release`: see `Leaving`.
class OthersRun {
 public:
  OthersRun() : state_(PyEval_SaveThread()) {}
  OthersRun(const OthersRun&) = delete;
  OthersRun& operator=(const OthersRun&) = delete;
  // CPython ends a thread by unwinding it: without noexcept(false) that is std::terminate.
  // NOLINTNEXTLINE(bugprone-unsafe-to-allow-exceptions)
  ~OthersRun() noexcept(false) {
    Leaving::enter();
    PyEval_RestoreThread(state_);
    Leaving::done();
  }

 private:
  PyThreadState* state_;
};

/// Deletes what ends a thread of its own, without the interpreter's lock: that thread may wait for it.
struct WithoutLock {
  template <class T>
  void operator()(T* object) const {
    if (PyGILState_Check() == 0) {
      delete object;
      return;
    }
    const OthersRun others_run;
    delete object;
  }
};

/// Takes the interpreter's lock for a scope; one that has it already keeps it.
class Held {
 public:
  Held() {
    if (entering_.first) Leaving::done();
  }

 private:
  struct Entering {
    bool first = PyGILState_Check() == 0;
    Entering() {
      if (first) Leaving::enter();
    }
  };
  Entering entering_;
  pybind11::gil_scoped_acquire held_;
};

}  // namespace ebac::python
