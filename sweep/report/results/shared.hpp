// Fields that the results of several commands have, and the kinds of rows. A field that only some outputs have is
// `optional`; null stands for any value that is not defined. NAME is the field of every other key.
#pragma once

#include "solver/field.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

namespace grainsweep::report::results {

using enum Field::Kind;

[[nodiscard]] constexpr Field amount(std::string_view name, std::string_view unit, std::string_view meaning) {
    return {name, number, meaning, {}, {}, {}, false, unit};
}
[[nodiscard]] constexpr Field sometimes(Field field) {
    field.optional = true;
    return field;
}
template <std::size_t m, std::size_t n>
[[nodiscard]] constexpr std::array<Field, m + n> joined(const std::array<Field, m>& a, const std::array<Field, n>& b) {
    std::array<Field, m + n> all{};
    std::ranges::copy(b, std::ranges::copy(a, all.begin()).out);
    return all;
}

inline constexpr Field campaign_name{"campaign", text, "name of the campaign"};
inline constexpr Field database_file{"database", text, "file of the database"};
inline constexpr Field file_size{"bytes", whole, "size of the file", {}, {}, {}, false, "bytes"};
inline constexpr Field case_hash{"case_id", text, "id of the case: a hash of scene, inputs and seed"};
inline constexpr Field case_seed{"seed", whole, "seed of the random numbers"};
inline constexpr Field scene_name{"scene", text, "name of the scene"};
inline constexpr Field scene_revision{"revision", whole, "revision of the scene; it grows when results change"};
inline constexpr Field observable_name{"observable", text, "name of the observable"};
inline constexpr Field observable_unit{"unit", text, "unit of the observable"};
inline constexpr Field factor_name{"factor", text, "name of the factor"};
inline constexpr Field candidate_points{"candidates", whole, "points of the design, before `where`"};
inline constexpr Field dropped_points{"dropped", whole, "points that `where` excludes"};
inline constexpr Field excluded_cases{"excluded", whole, "cases without a value, which are left out"};
inline constexpr Field notes_to_read{"notes", words, "sentences to read before the numbers are quoted"};
inline constexpr Field wall_seconds = amount("wall_seconds", "s", "duration");
inline constexpr Field peak_memory = amount("peak_memory", "bytes", "largest memory of the program");
inline constexpr Field exit_status{"exit_status", whole, "exit status of the program"};
inline constexpr Field exit_code{"exit_code", whole, "exit code of the command"};

inline constexpr auto input_values = std::to_array<Field>({{"NAME", value, "value of an input, in its unit"}});
inline constexpr Field inputs = holding({"inputs", object, "values of the inputs"}, input_values);

/// Estimate with its error.
inline constexpr auto estimate = std::to_array<Field>({
    {"value", number, "estimate"},
    {"error", number, "95 % half-width"},
});

}  // namespace grainsweep::report::results
