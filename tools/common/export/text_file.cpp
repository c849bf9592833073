#include "common/export/text_file.h"

#include <cerrno>
#include <cstring>
#include <stdexcept>

extern "C" {
#include "base/trig.h"
#include "config/decimal.h"
}

namespace ale
{

TextFile::TextFile(const std::string &path)
    : path_(path), file_(path == "-" ? stdout : std::fopen(path.c_str(), "we"))
{
    check(file_ != nullptr);
}

TextFile::~TextFile()
{
    if (file_ && file_ != stdout) {
        std::fclose(file_);
    }
}

void TextFile::check(bool good)
{
    if (!good) {
        throw std::runtime_error(path_ + ": " + std::strerror(errno));
    }
}

TextFile &TextFile::put(std::string_view text)
{
    check(text.empty() || std::fwrite(text.data(), text.size(), 1, file_) == 1);
    return *this;
}

TextFile &TextFile::put_integer(int64_t value)
{
    return put(std::to_string(value));
}

TextFile &TextFile::put_decimal(int64_t value, unsigned digits)
{
    char text[ALE_DECIMAL_TEXT];
    ale_decimal_print(value, digits, text);
    return put(text);
}

TextFile &TextFile::put_scaled(int64_t value, int exponent)
{
    put_integer(value);
    return value == 0 ? *this : put("e").put_integer(exponent);
}

TextFile &TextFile::put_angle(uint32_t angle_bam)
{
    return put_decimal(ale_bam_to_nrad(ale_bam_diff(angle_bam, 0)), 9);
}

void TextFile::close()
{
    std::FILE *file = file_;
    file_ = nullptr;
    check(file == stdout ? std::fflush(file) == 0 : std::fclose(file) == 0);
}

} // namespace ale
