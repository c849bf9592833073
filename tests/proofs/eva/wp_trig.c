/* What takes two variables at once to see: for WP, one function at a time. The rest of them is Eva's
 * (base_trig.c).
 *
 * proves: lib/base/trig.c
 * wp: ratio_q40 octant_arctan ale_atan2_bam
 * options: -wp-prop=@requires,@assert,@ensures */
