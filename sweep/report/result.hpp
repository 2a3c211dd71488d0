// Results of commands: JSON objects and tables whose keys are fields (solver/field.hpp) with a unit and a meaning. The
// fields of every command are in sweep/report/results; docs/json.md is generated from them.
#pragma once

#include "solver/field.hpp"
#include "sweep/report/table.hpp"

#include <algorithm>
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <vector>

namespace grainsweep::report {

/// JSON object whose keys are names of `fields`; any other key does not compile. Keys that a user chooses are added to
/// a plain Json.
template <const auto& fields>
class Result : public Json {
public:
    /// Field of a name.
    struct Key {
        const Field* field;

        template <std::size_t size>
        consteval Key(const char (&name)[size])
            : field(std::ranges::find(fields, std::string_view(name), &Field::name)) {
            if (field == std::ranges::end(fields)) throw "there is no field of this name";
        }
    };
    struct Member {
        Key key;
        Json value;
    };

    Result(std::initializer_list<Member> members = {}) : Json(object()) {
        for (const auto& [key, value] : members) add(key, value);
    }
    Result& add(Key key, const Json& value) {
        Json::add(key.field->name, value);
        return *this;
    }
    /// Adds every member of another result, whose fields are also of this one.
    template <const auto& others>
    Result& add(const Result<others>& other) {
        static_assert(std::ranges::all_of(
            others, [](const Field& one) { return std::ranges::count(fields, one.name, &Field::name) == 1; }));
        Json::add(static_cast<const Json&>(other));
        return *this;
    }
};

/// Returns the names of fields as columns of a table.
[[nodiscard]] inline std::vector<std::string> columns_of(std::span<const Field> fields) {
    std::vector<std::string> names;
    for (const auto& field : fields) names.emplace_back(field.name);
    return names;
}

}  // namespace grainsweep::report
