// Plain twin of the smoother: locally weighted regression, weights (8) to the first beam outside the window,
// robust weights (9), product (10).
#ifndef ALE_TESTS_REFERENCE_ROBUST_LOWESS_H
#define ALE_TESTS_REFERENCE_ROBUST_LOWESS_H

#include <algorithm>
#include <cmath>
#include <vector>

#include <Eigen/Dense>

namespace reference
{

class robust_lowess
{
  public:
    robust_lowess(int beams, int most_passes, double least_mad)
        : span(beams), passes(most_passes), mad_floor(least_mad)
    {
    }

    std::vector<double> operator()(const std::vector<int> &beam, const std::vector<double> &value) const
    {
        std::vector<double> robust(value.size(), 1.0);
        std::vector<double> smooth = regress(beam, value, robust);
        for (int pass = 0; pass < passes; pass++) {
            const double mad = std::max(median_residual(value, smooth), mad_floor);
            bool asked = false;
            for (size_t i = 0; i < value.size(); i++) {
                const double e = std::fabs(value[i] - smooth[i]);
                robust[i] = e < 6 * mad ? std::pow(1 - std::pow(e / (6 * mad), 2), 2) : 0.0;
                asked = asked || e > 3 * mad;
            }
            if (!asked) {
                break;
            }
            smooth = regress(beam, value, robust);
        }
        return smooth;
    }

  private:
    static double median_residual(const std::vector<double> &value, const std::vector<double> &smooth)
    {
        std::vector<double> e;
        for (size_t i = 0; i < value.size(); i++) {
            e.push_back(std::fabs(value[i] - smooth[i]));
        }
        std::nth_element(e.begin(), e.begin() + static_cast<long>(e.size() / 2), e.end());
        return e[e.size() / 2];
    }

    std::vector<double> regress(const std::vector<int> &beam, const std::vector<double> &value,
                                const std::vector<double> &robust) const
    {
        std::vector<double> smooth;
        for (size_t i = 0; i < value.size(); i++) {
            const int cut = std::min({beam[i] - beam.front(), beam.back() - beam[i], span / 2});
            const double reach = span - cut;
            Eigen::Matrix2d normal = Eigen::Matrix2d::Zero();
            Eigen::Vector2d right = Eigen::Vector2d::Zero();
            for (size_t k = 0; k < value.size(); k++) {
                const double dx = beam[k] - beam[i];
                if (std::fabs(dx) < reach) {
                    const double w = std::pow(1 - std::pow(std::fabs(dx) / reach, 3), 3) * robust[k];
                    const Eigen::Vector2d row(1.0, dx);
                    normal += w * row * row.transpose();
                    right += w * row * value[k];
                }
            }
            smooth.push_back(normal.determinant() > 1e-9 ? normal.ldlt().solve(right)(0) : value[i]);
        }
        return smooth;
    }

    int span;
    int passes;
    double mad_floor;
};

} // namespace reference

#endif
