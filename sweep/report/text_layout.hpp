// Text that fits the width of a terminal.
#pragma once

#include <cstddef>
#include <iosfwd>
#include <limits>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace grainsweep::report {

inline constexpr std::size_t unlimited_width = std::numeric_limits<std::size_t>::max();

/// Columns of text on standard output: from set_text_width(), else from the terminal, else from the environment
/// variable COLUMNS, else 100 (a pipe, a file). At least 20.
[[nodiscard]] std::size_t text_width();
/// For the rest of the process; 0 restores the default.
void set_text_width(std::size_t columns);

/// Characters of the text (UTF-8); a wide or a combining one counts as one.
[[nodiscard]] std::size_t columns_of(std::string_view text);

/// Columns of the longest word; a "±" and the word behind it are one.
[[nodiscard]] std::size_t longest_word(std::string_view text);

/// The text in lines of at most `width` columns, broken between words. A longer word is cut, behind a sign such as "_"
/// where it has one, or stays whole. At least one line.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t width, bool cut = true);

/// While it lives, lines longer than `width` that are written to `out` are broken between words. Continuations are
/// indented to the text of the line: behind its spaces, and behind a label with two spaces or more after it.
class WrappedOutput {
public:
    WrappedOutput(std::ostream& out, std::size_t width);
    WrappedOutput(const WrappedOutput&) = delete;
    WrappedOutput& operator=(const WrappedOutput&) = delete;
    ~WrappedOutput();

private:
    class Buffer;
    std::ostream* out_;
    std::unique_ptr<Buffer> buffer_;
};

}  // namespace grainsweep::report
