/* --features: lines, corners and curves of a scan as one JSON object a line. */
#ifndef ALE_LAB_REPLAY_FEATURES_FILE_H
#define ALE_LAB_REPLAY_FEATURES_FILE_H

#include "common/export/text_file.h"

extern "C" {
#include "extract/extract.h"
}

namespace ale
{

class FeaturesFile
{
  public:
    explicit FeaturesFile(const std::string &path) : file_(path)
    {
    }
    /* features == nullptr: the scan was lost on its way. */
    void put(uint32_t scan, int64_t stamp_us, const ale_features_t *features);
    void close()
    {
        file_.close();
    }

  private:
    void put_line(const ale_line_t &line);
    void put_corner(const ale_corner_t &corner);
    void put_curve(const ale_curve_t &curve);
    void put_refused(const ale_features_t &features);
    void put_covariance(int64_t first, int64_t mixed, int64_t second, int first_exponent, int mixed_exponent);
    void put_point(const ale_point_t &p, const char *x_name, const char *y_name);

    TextFile file_;
};

} // namespace ale

#endif
