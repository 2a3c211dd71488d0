// Text for a terminal: how wide it is, how wide characters are, and lines that keep to it.
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

/// Columns of text on standard output: what set_text_width() says, else the terminal's, else the environment variable
/// COLUMNS, else 100 (a pipe, a file). At least 20.
[[nodiscard]] std::size_t text_width();
/// For the rest of the process; 0: found out anew.
void set_text_width(std::size_t columns);

/// Columns a text takes on a terminal: none for a combining mark, two for wide East Asian characters, one otherwise.
[[nodiscard]] std::size_t columns_of(std::string_view text);

/// The words of a text between its spaces; a "±" and what follows it are one.
[[nodiscard]] std::vector<std::string> unbroken(std::string_view text);

/// The text in lines of at most `width` columns, broken at white space (never after "±"); a longer word is broken
/// after a letter that is none or a digit where it has one, else anywhere. At least one line.
[[nodiscard]] std::vector<std::string> wrapped(std::string_view text, std::size_t width);

/// While it lives, lines longer than `width` that go to `out` are broken at spaces, and their continuations begin where
/// the text of the line begins: after its white space, and after a first word that stands as a label with two spaces
/// or more behind it. Words longer than the width (a path) stay whole.
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
