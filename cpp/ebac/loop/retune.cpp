#include "ebac/loop/retune.hpp"

#include <stdexcept>
#include <string>

#include "ebac/control/fixed_params.hpp"
#include "ebac/core/check.hpp"

namespace ebac {

void check_tuning(const Tuning& now, const Tuning& next) {
  if (const FieldRow* field = fixed_change(now.table, now.params, next.params)) {
    throw std::invalid_argument(std::string(now.name) + "." + std::string(field->name) + " = " +
                                shortest(field->number(next.params)) + " " +
                                std::string(field->unit) + ": cannot change from " +
                                shortest(field->number(now.params)) +
                                " while the loop runs; stop it first");
  }
  if (now.timing != next.timing) {
    throw std::invalid_argument(std::string(now.name) +
                                ": its timing cannot change while the loop runs; stop it first");
  }
}

void check_retune(const AnyLaw& now, const AnyLaw& next) {
  if (&now.type() != &next.type()) {
    throw std::invalid_argument(std::string(now.type().name) + ": cannot become " +
                                std::string(next.type().name) +
                                " while the loop runs; stop it first");
  }
  if (!now.type().tunable) {
    throw std::invalid_argument(
        std::string(now.type().name) +
        ": its parameters cannot change while the loop runs, as the law has "
        "no `retune`; stop it first");
  }
  const auto tuning = [](const AnyLaw& law) -> Tuning {
    return {law.type().name, law.type().params, law.params(), law.timing()};
  };
  check_tuning(tuning(now), tuning(next));
}

}  // namespace ebac
