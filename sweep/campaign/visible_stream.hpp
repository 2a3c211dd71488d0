// A stream that shows control characters instead of sending them to the terminal: names, messages and logs come from
// databases, programs and files of anybody.
#pragma once

#include <ostream>
#include <streambuf>

namespace grainsweep::campaign {

/// Stands in front of a stream's buffer until it goes.
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
    bool half_ = false;  ///< the first byte of a character that may be a control character waits for its second
};

}  // namespace grainsweep::campaign
