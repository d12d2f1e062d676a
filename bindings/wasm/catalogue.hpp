#pragma once

#include <string>

namespace ebac::wasm {

/// What a page can choose and show, as JSON: laws, settings, columns of a row, measures of a
/// contact; each with its unit, meaning, range and default where it has one.
std::string catalogue();

}  // namespace ebac::wasm
