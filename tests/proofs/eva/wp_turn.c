/* Sums that grow by at most so much a point: for WP.
 *
 * proves: lib/base/turn.c
 * with: lib/base/fixed.c lib/base/scan.c lib/base/trig.c
 * wp: is_clockwise step_of add_joined gap_bam
 * options: -wp-prop=@invariant,@ensures,@assigns,@requires */
