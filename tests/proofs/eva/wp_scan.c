/* Sums that grow by at most one a beam: for WP.
 *
 * proves: lib/base/scan.c
 * with: lib/base/fixed.c lib/base/trig.c
 * wp: ale_scan_is_sparse
 * options: -wp-rte */
