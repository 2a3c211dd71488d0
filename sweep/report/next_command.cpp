#include "sweep/report/next_command.hpp"

#include <algorithm>
#include <cctype>
#include <cerrno>  // program_invocation_name, of the GNU C library

namespace grainsweep::report {

std::string shell_word(std::string_view word) {
    constexpr std::string_view plain = "_-./,:=@%+";
    const bool safe = !word.empty() && std::ranges::all_of(word, [&](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) != 0 || plain.find(c) != std::string_view::npos;
    });
    if (safe) return std::string(word);
    std::string quoted = "'";
    for (const char c : word) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return quoted + "'";
}

std::string next_command(std::string_view arguments) {
    return shell_word(program_invocation_name) + " " + std::string(arguments);
}

}  // namespace grainsweep::report
