// One page that holds a whole database: figures, pictures and the program that draws them, in one file that asks
// nothing of any network.
#pragma once

#include "sweep/store/store.hpp"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <iosfwd>
#include <string>
#include <string_view>

namespace grainsweep::report {

/// Pictures hold at most so many cases, drawn evenly at random from the campaign; statistics are over all.
inline constexpr std::size_t most_drawn_cases = 1500;
/// Failed cases that are listed one by one.
inline constexpr std::size_t most_listed_failures = 200;

/// The figures of every campaign of the store, as the page's program reads them. `database` is only its name.
[[nodiscard]] nlohmann::ordered_json page_data(const store::Store& store, std::string_view database);

/// JSON that may stand inside a script element: "</", "<!--" and the line separators of JavaScript cannot occur.
[[nodiscard]] std::string safe_in_script(const nlohmann::ordered_json& value);

/// Writes the page. Bytes of the database that are no UTF-8 are replaced.
void write_page(std::ostream& out, const store::Store& store, std::string_view database);

}  // namespace grainsweep::report
