/* A result file written as text. Numbers are printed from integers: the same bytes on every machine.
 *
 *   TextFile file("out.tum");           throws std::runtime_error: "out.tum: No such file or directory"
 *   file.put("x ").put_decimal(pose.x_um, 6).put("\n");
 *   file.close();                        throws when the disk is full; without it the file may be incomplete
 *
 * "-" is the standard output. */
#ifndef ALE_COMMON_EXPORT_TEXT_FILE_H
#define ALE_COMMON_EXPORT_TEXT_FILE_H

#include <cstdint>
#include <cstdio>
#include <string>
#include <string_view>

namespace ale
{

class TextFile
{
  public:
    explicit TextFile(const std::string &path);
    ~TextFile();
    TextFile(const TextFile &) = delete;
    TextFile &operator=(const TextFile &) = delete;

    TextFile &put(std::string_view text);
    TextFile &put_integer(int64_t value);
    /* value / 10^digits, digits 0..9, without superfluous zeros. */
    TextFile &put_decimal(int64_t value, unsigned digits);
    /* value * 10^exponent, as "123e-18": for covariances. */
    TextFile &put_scaled(int64_t value, int exponent);
    /* Radians, -pi to pi, nine digits. */
    TextFile &put_angle(uint32_t angle_bam);
    void close();

  private:
    void check(bool good);

    std::string path_;
    std::FILE *file_;
};

} // namespace ale

#endif
