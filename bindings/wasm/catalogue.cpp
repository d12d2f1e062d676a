#include "catalogue.hpp"

#include <cmath>

#include "ebac/control/law_types.hpp"
#include "ebac/core/check.hpp"
#include "live_run.hpp"
#include "settings.hpp"

namespace ebac::wasm {

namespace {

std::string quoted(std::string_view text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// JSON has no infinity.
std::string number(double value) { return std::isfinite(value) ? shortest(value) : "null"; }

void add(std::string& list, const std::string& item) {
  list += list.empty() ? "" : ",\n";
  list += item;
}

std::string described(const FieldRow& field, std::string_view prefix) {
  const std::string dot = prefix.empty() ? "" : ".";
  return "{\"name\":" + quoted(std::string(prefix) + dot + std::string(field.name)) +
         ",\"unit\":" + quoted(field.unit) + ",\"meaning\":" + quoted(field.meaning);
}

std::string laws() {
  std::string list;
  for (const LawType* type : law_types()) {
    add(list, "{\"name\":" + quoted(type->name) + ",\"summary\":" + quoted(type->summary) +
                  ",\"passive\":" + (type->passive ? "true" : "false") + "}");
  }
  return list;
}

std::string settings() {
  std::string list;
  Setup setup;
  for (const Part& part : parts_of(setup)) {
    for (const FieldRow& field : part.table->rows) {
      add(list, described(field, part.prefix) + ",\"low\":" + number(field.low) + ",\"high\":" +
                    number(field.high) + ",\"default\":" + number(field.number(part.owner)) + "}");
    }
  }
  return list;
}

template <Described T>
std::string fields_of() {
  std::string list;
  for (const FieldRow& field : field_table<T>().rows) add(list, described(field, "") + "}");
  return list;
}

/// What the core makes of the measures, 1 for yes.
std::string verdicts() {
  return ",\n{\"name\":\"still\",\"unit\":\"1\",\"meaning\":\"swings little enough\"}"
         ",\n{\"name\":\"force_quiet\",\"unit\":\"1\",\"meaning\":\"vibrates little enough\"}";
}

}  // namespace

std::string catalogue() {
  return "{\"laws\":[" + laws() + "],\n\"settings\":[" + settings() + "],\n\"columns\":[" +
         fields_of<Shown>() + "],\n\"measures\":[" + fields_of<WallContact>() + verdicts() + "]}";
}

}  // namespace ebac::wasm
