/* What takes two variables at once to see: for WP, one function at a time.
 *
 * proves: lib/base/fixed.c
 * wp: ale_round_div ale_abs64 ale_min64 ale_max64 ale_clamp64
 * options: -wp-rte */
