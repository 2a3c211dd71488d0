// Stream that shows control characters instead of sending them to the terminal, because names, messages and logs can
// come from untrusted databases, programs and files.
#pragma once

#include <ostream>
#include <streambuf>

namespace grainsweep::campaign {

/// Filter in front of a stream's buffer, until it is destroyed.
class VisibleStream : public std::streambuf {
public:
    explicit VisibleStream(std::ostream& stream);
    VisibleStream(const VisibleStream&) = delete;
    VisibleStream& operator=(const VisibleStream&) = delete;
    ~VisibleStream() override;

protected:
    int_type overflow(int_type c) override;
    std::streamsize xsputn(const char* text, std::streamsize count) override;
    int sync() override;

private:
    std::ostream& stream_;
    std::streambuf* behind_;
    bool half_ = false;  ///< the first byte of a possible control character is stored until the second one
};

}  // namespace grainsweep::campaign
