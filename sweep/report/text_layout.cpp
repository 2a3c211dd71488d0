#include "sweep/report/text_layout.hpp"

#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <cstdlib>
#include <ostream>
#include <span>
#include <streambuf>
#include <utility>

namespace grainsweep::report {

namespace {

constexpr std::size_t narrowest = 20;
constexpr std::size_t where_nothing_says = 100;
constexpr std::size_t widest_label = 24;  // a longer beginning of a line is text, not its label

std::size_t chosen_width = 0;

struct Range {
    std::uint32_t first, last;
};

// Unicode 15: blocks of combining marks and marks of no width; blocks of East Asian Width W and F.
constexpr std::array no_width = {Range{0x0300, 0x036F}, Range{0x0483, 0x0489}, Range{0x0591, 0x05BD},
                                 Range{0x0610, 0x061A}, Range{0x064B, 0x065F}, Range{0x1AB0, 0x1AFF},
                                 Range{0x1DC0, 0x1DFF}, Range{0x200B, 0x200F}, Range{0x20D0, 0x20FF},
                                 Range{0xFE00, 0xFE0F}, Range{0xFE20, 0xFE2F}, Range{0xFEFF, 0xFEFF}};
constexpr std::array double_width = {Range{0x1100, 0x115F},   Range{0x2E80, 0x303E},  Range{0x3041, 0x33FF},
                                     Range{0x3400, 0x4DBF},   Range{0x4E00, 0x9FFF},  Range{0xA000, 0xA4CF},
                                     Range{0xAC00, 0xD7A3},   Range{0xF900, 0xFAFF},  Range{0xFE30, 0xFE4F},
                                     Range{0xFF00, 0xFF60},   Range{0xFFE0, 0xFFE6},  Range{0x1F300, 0x1F64F},
                                     Range{0x1F900, 0x1F9FF}, Range{0x20000, 0x3FFFD}};

bool within(std::uint32_t code, std::span<const Range> ranges) {
    return std::ranges::any_of(ranges, [code](Range range) { return code >= range.first && code <= range.last; });
}

bool continues(char c) {
    return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U;
}

/// Bytes of the character that begins at `start`.
std::size_t length_at(std::string_view text, std::size_t start) {
    std::size_t end = start + 1;
    while (end < text.size() && continues(text[end])) ++end;
    return end - start;
}

std::size_t columns_at(std::string_view character) {
    const auto lead = static_cast<unsigned char>(character.front());
    if (lead < 0x80U || character.size() == 1) return 1;
    std::uint32_t code = lead & (0xFFU >> (character.size() + 1));
    for (const char c : character.substr(1)) code = code << 6U | (static_cast<unsigned char>(c) & 0x3FU);
    return within(code, no_width) ? 0 : within(code, double_width) ? 2 : 1;
}

/// Bytes at the beginning of the word that fit into the width, cut behind a sign where there is one.
std::size_t fitting(std::string_view word, std::size_t width) {
    std::size_t bytes = 0, used = 0, behind_sign = 0;
    while (bytes < word.size()) {
        const std::size_t length = length_at(word, bytes);
        used += columns_at(word.substr(bytes, length));
        if (used > width && bytes > 0) break;
        const char c = word[bytes];
        bytes += length;
        if (c == '_' || c == '/' || c == ',' || c == '-' || c == '.' || c == ':' || c == '|') behind_sign = bytes;
    }
    return bytes < word.size() && behind_sign > 0 ? behind_sign : bytes;
}

constexpr std::string_view error_sign = "±";

std::size_t terminal_width() {
    winsize size{};
    return ::isatty(STDOUT_FILENO) == 1 && ::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 ? size.ws_col : 0;
}

std::size_t environment_width() {
    const char* columns = std::getenv("COLUMNS");
    if (columns == nullptr) return 0;
    const std::string_view word = columns;
    std::size_t width = 0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), width);
    return error == std::errc() && end == word.data() + word.size() ? width : 0;
}

}  // namespace

std::size_t text_width() {
    std::size_t width = chosen_width;
    if (width == 0) width = terminal_width();
    if (width == 0) width = environment_width();
    if (width == 0) width = where_nothing_says;
    return std::max(width, narrowest);
}

void set_text_width(std::size_t columns) {
    chosen_width = columns;
}

std::size_t columns_of(std::string_view text) {
    std::size_t columns = 0;
    for (std::size_t at = 0; at < text.size();) {
        const std::size_t length = length_at(text, at);
        columns += columns_at(text.substr(at, length));
        at += length;
    }
    return columns;
}

std::vector<std::string> unbroken(std::string_view text) {
    std::vector<std::string> words;
    bool joined = false;
    for (std::size_t at = 0; (at = text.find_first_not_of(' ', at)) != std::string_view::npos;) {
        const std::size_t end = std::min(text.find(' ', at), text.size());
        const auto word = text.substr(at, end - at);
        if (joined) {
            words.back().append(" ").append(word);
        } else {
            words.emplace_back(word);
        }
        joined = word == error_sign;
        at = end;
    }
    return words;
}

std::vector<std::string> wrapped(std::string_view text, std::size_t width) {
    if (columns_of(text) <= width) return {std::string(text)};
    std::vector<std::string> lines;
    std::string line;
    std::size_t used = 0;
    const auto end_line = [&] {
        lines.push_back(std::exchange(line, {}));
        used = 0;
    };
    for (std::string_view word : unbroken(text)) {
        if (used > 0 && used + 1 + columns_of(word) > width) end_line();
        while (columns_of(word) > width) {
            const std::size_t bytes = fitting(word, width);
            lines.emplace_back(word.substr(0, bytes));
            word.remove_prefix(bytes);
        }
        if (used > 0) line += ' ';
        line += word;
        used = columns_of(line);
    }
    if (used > 0 || lines.empty()) end_line();
    return lines;
}

/// Collects a line, breaks it and hands it on. What the stream behind does not take is an error of this one.
class WrappedOutput::Buffer : public std::streambuf {
public:
    Buffer(std::streambuf& behind, std::size_t width) : behind_(&behind), width_(width) {}
    [[nodiscard]] std::streambuf* behind() const { return behind_; }
    bool hand_on() {  // what there is of a line
        return line_.empty() || write(std::exchange(line_, {}));
    }

protected:
    int_type overflow(int_type c) override {
        if (traits_type::eq_int_type(c, traits_type::eof())) return traits_type::not_eof(c);
        const char byte = traits_type::to_char_type(c);
        return xsputn(&byte, 1) == 1 ? c : traits_type::eof();
    }
    std::streamsize xsputn(const char* bytes, std::streamsize count) override {
        std::string_view rest(bytes, static_cast<std::size_t>(count));
        for (auto end = rest.find('\n'); end != std::string_view::npos; end = rest.find('\n')) {
            line_ += rest.substr(0, end);
            if (!write_lines(std::exchange(line_, {}))) return 0;
            rest.remove_prefix(end + 1);
        }
        line_ += rest;
        return count;
    }
    int sync() override { return behind_->pubsync(); }

private:
    bool write(std::string_view text) {
        return behind_->sputn(text.data(), static_cast<std::streamsize>(text.size())) ==
               static_cast<std::streamsize>(text.size());
    }
    [[nodiscard]] static std::size_t indentation_of(std::string_view line) {
        const std::size_t start = std::min(line.find_first_not_of(' '), line.size());
        const std::size_t label_end = line.find("  ", start);
        if (label_end > widest_label) return start;
        const std::size_t behind = line.find_first_not_of(' ', label_end);
        return behind == std::string_view::npos || behind > widest_label ? start : behind;
    }
    bool write_lines(const std::string& line) {
        if (columns_of(line) <= width_) return write(line + '\n');
        const std::size_t indentation = indentation_of(line);
        std::string out = line.substr(0, indentation);
        std::size_t used = indentation;
        bool first = true;
        for (const auto& word : unbroken(std::string_view(line).substr(indentation))) {
            const std::size_t columns = columns_of(word);
            if (!first && used + 1 + columns > width_) {
                out += '\n' + std::string(indentation, ' ');
                used = indentation;
            } else if (!first) {
                out += ' ';
                ++used;
            }
            out += word;
            used += columns;
            first = false;
        }
        return write(out + '\n');
    }

    std::streambuf* behind_;
    std::size_t width_;
    std::string line_;
};

WrappedOutput::WrappedOutput(std::ostream& out, std::size_t width)
    : out_(&out), buffer_(std::make_unique<Buffer>(*out.rdbuf(), width)) {
    out.rdbuf(buffer_.get());
}

WrappedOutput::~WrappedOutput() {
    auto state = out_->rdstate();  // setting a buffer forgets it
    if (!buffer_->hand_on()) state |= std::ios::badbit;
    out_->rdbuf(buffer_->behind());
    out_->clear(state);
}

}  // namespace grainsweep::report
