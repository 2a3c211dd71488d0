// Wrapping of text to the width of a terminal.
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

/// Returns the columns of standard output: from set_text_width(), else from the terminal, else from the environment
/// variable COLUMNS, else 100 (a pipe, a file). At least 20.
[[nodiscard]] std::size_t text_width();
/// Sets the columns for the rest of the process; 0 restores the default.
void set_text_width(std::size_t columns);

/// Returns the number of characters of the text (UTF-8); wide and combining ones count as one.
[[nodiscard]] std::size_t columns_of(std::string_view text);

/// Returns the columns of the longest word; a "±" and the word behind it are one word.
[[nodiscard]] std::size_t longest_word(std::string_view text);

/// Returns the text in lines of at most `width` columns, broken between words; at least one line. A longer word is cut,
/// if possible behind a sign such as "_", or, without `cut`, kept whole.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t width, bool cut = true);

/// Filter that, during its lifetime, breaks lines longer than `width` written to `out` between words. Continuations are
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
