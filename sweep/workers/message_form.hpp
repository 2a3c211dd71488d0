// The one form of JSON in which this program writes the messages that every case costs, Run, Begun and Done: keys
// sorted, no spaces. Written and read without building a document, several times as fast; a line in any other form is
// for the reader of documents in message.cpp.
#pragma once

#include "sweep/workers/message.hpp"

#include <optional>
#include <string>
#include <string_view>

namespace grainsweep::workers {

[[nodiscard]] std::string in_form(const Run& run);
[[nodiscard]] std::string in_form(const Begun& begun);
[[nodiscard]] std::string in_form(const Done& done);

/// None where the line is in another form, or no message of this kind.
[[nodiscard]] std::optional<Run> run_in_form(std::string_view line);
[[nodiscard]] std::optional<Begun> begun_in_form(std::string_view line);
[[nodiscard]] std::optional<Done> done_in_form(std::string_view line);

}  // namespace grainsweep::workers
