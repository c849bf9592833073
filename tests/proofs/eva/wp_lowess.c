/* What takes two variables at once to see: for WP, one function at a time. The rest of them is Eva's
 * (extract_lowess.c).
 *
 * proves: lib/extract/lowess.c
 * with: lib/base/fixed.c lib/base/histogram.c
 * wp: reach_at smooth_at
 * options: -wp-prop=@assert,@ensures */
