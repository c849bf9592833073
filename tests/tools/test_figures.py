"""The arithmetic behind the figures: criteria and expected error."""
import numpy as np
import pytest

import criteria


def test_points_on_a_line_have_no_residual_of_either_kind():
    x = np.linspace(-1, 1, 20)
    y = 0.5 * x + 2
    assert np.abs(criteria.residuals_along_y(x, y)).max() < 1e-12
    assert np.abs(criteria.residuals_along_normal(x, y)).max() < 1e-12


def test_the_residual_along_the_normal_does_not_depend_on_the_axes():
    random = np.random.default_rng(1)
    x, y = criteria.wall_scan(2.0, 0.3, criteria.SMOOTH, random)
    turned_x, turned_y = np.cos(1.1) * x - np.sin(1.1) * y, np.sin(1.1) * x + np.cos(1.1) * y
    before = np.sqrt((criteria.residuals_along_normal(x, y) ** 2).mean())
    after = np.sqrt((criteria.residuals_along_normal(turned_x, turned_y) ** 2).mean())
    assert after == pytest.approx(before, rel=1e-9)
    along_y = np.sqrt((criteria.residuals_along_y(turned_x, turned_y) ** 2).mean())
    assert along_y > 1.2 * after


def test_the_printed_mean_absolute_error_is_rmse_over_root_n():
    residuals = np.array([1.0, -2.0, 3.0, -4.0])
    values = criteria.criteria(residuals, np.arange(4.0))
    assert values["(20)"] == pytest.approx(values["RMSE"] / 2)
    assert values["MAE"] == pytest.approx(2.5)


@pytest.mark.parametrize("slope", [-2.0, -0.5, 0.5, 2.0])
def test_the_corrected_expected_error_is_what_monte_carlo_gives_and_the_printed_is_not(slope):
    random = np.random.default_rng(2)
    arguments = (slope, 3.0, np.radians(40), 0.01, np.radians(0.1))
    true = criteria.simulated_mse(*arguments, random)
    assert criteria.expected_mse(*arguments) == pytest.approx(true, rel=0.02)
    assert abs(criteria.expected_mse_printed(*arguments) / true - 1) > 0.1


def test_the_normal_form_is_the_corrected_one_over_one_plus_the_slope_squared():
    for slope in (-3.0, 0.2, 1.5):
        along_y = criteria.expected_mse(slope, 2.0, 0.7, 0.008, 0.002)
        along_normal = criteria.expected_normal_mse(np.arctan2(1, -slope), 2.0, 0.7, 0.008, 0.002)
        assert along_normal * (1 + slope**2) == pytest.approx(along_y)
