package skein.learn;

import jdk.incubator.vector.FloatVector;
import jdk.incubator.vector.VectorSpecies;

/**
 * Products of matrices, which are nearly all of a dense network's work. Every element is summed separately,
 * in the order of the inner index, each term by a fused multiply-add: so its bits do not depend on the width
 * of the machine's vectors.
 */
final class DenseKernel {
  private DenseKernel() {}

  private static final VectorSpecies<Float> SPECIES = FloatVector.SPECIES_PREFERRED;
  private static final int LANES = SPECIES.length();

  /**
   * C += A B, with A of {@code rows} times {@code inner} elements, B of {@code inner} times {@code
   * columns}.
   *
   * @param a the matrix A; element (r, k) has the index {@code aAt + r * aRow + k * aStep}
   * @param b the matrix B, row by row from {@code bAt}
   * @param c the matrix C, row by row from {@code cAt}
   */
  static void addProduct(
      int rows, int inner, int columns,
      float[] a, int aAt, int aRow, int aStep,
      float[] b, int bAt,
      float[] c, int cAt) {
    int column = 0;
    for (; column + 4 * LANES <= columns; column += 4 * LANES) {
      int row = 0;
      for (; row + 2 <= rows; row += 2)
        two(inner, columns, a, aAt + row * aRow, aRow, aStep, b, bAt + column, c, cAt + row * columns + column);
      if (row < rows)
        for (int part = 0; part < 4; part++)
          one(
              inner, columns, a, aAt + row * aRow, aStep,
              b, bAt + column + part * LANES, c, cAt + row * columns + column + part * LANES);
    }
    for (; column + LANES <= columns; column += LANES) {
      int row = 0;
      for (; row + 4 <= rows; row += 4)
        four(inner, columns, a, aAt + row * aRow, aRow, aStep, b, bAt + column, c, cAt + row * columns + column);
      for (; row < rows; row++)
        one(inner, columns, a, aAt + row * aRow, aStep, b, bAt + column, c, cAt + row * columns + column);
    }
    for (; column < columns; column++) {
      int row = 0;
      for (; row + 4 <= rows; row += 4)
        column(inner, columns, a, aAt + row * aRow, aRow, aStep, b, bAt + column, c, cAt + row * columns + column);
      for (; row < rows; row++) {
        int at = cAt + row * columns + column;
        float sum = c[at];
        for (int k = 0; k < inner; k++)
          sum = Math.fma(a[aAt + row * aRow + k * aStep], b[bAt + k * columns + column], sum);
        c[at] = sum;
      }
    }
  }

  /** Computes two rows of four vectors each, which fill the registers. */
  private static void two(
      int inner, int columns, float[] a, int aAt, int aRow, int aStep, float[] b, int bAt, float[] c, int cAt) {
    int second = cAt + columns;
    FloatVector c00 = FloatVector.fromArray(SPECIES, c, cAt),
        c01 = FloatVector.fromArray(SPECIES, c, cAt + LANES),
        c02 = FloatVector.fromArray(SPECIES, c, cAt + 2 * LANES),
        c03 = FloatVector.fromArray(SPECIES, c, cAt + 3 * LANES),
        c10 = FloatVector.fromArray(SPECIES, c, second),
        c11 = FloatVector.fromArray(SPECIES, c, second + LANES),
        c12 = FloatVector.fromArray(SPECIES, c, second + 2 * LANES),
        c13 = FloatVector.fromArray(SPECIES, c, second + 3 * LANES);
    for (int k = 0; k < inner; k++) {
      FloatVector a0 = FloatVector.broadcast(SPECIES, a[aAt + k * aStep]),
          a1 = FloatVector.broadcast(SPECIES, a[aAt + aRow + k * aStep]);
      int at = bAt + k * columns;
      FloatVector b0 = FloatVector.fromArray(SPECIES, b, at),
          b1 = FloatVector.fromArray(SPECIES, b, at + LANES),
          b2 = FloatVector.fromArray(SPECIES, b, at + 2 * LANES),
          b3 = FloatVector.fromArray(SPECIES, b, at + 3 * LANES);
      c00 = a0.fma(b0, c00);
      c01 = a0.fma(b1, c01);
      c02 = a0.fma(b2, c02);
      c03 = a0.fma(b3, c03);
      c10 = a1.fma(b0, c10);
      c11 = a1.fma(b1, c11);
      c12 = a1.fma(b2, c12);
      c13 = a1.fma(b3, c13);
    }
    c00.intoArray(c, cAt);
    c01.intoArray(c, cAt + LANES);
    c02.intoArray(c, cAt + 2 * LANES);
    c03.intoArray(c, cAt + 3 * LANES);
    c10.intoArray(c, second);
    c11.intoArray(c, second + LANES);
    c12.intoArray(c, second + 2 * LANES);
    c13.intoArray(c, second + 3 * LANES);
  }

  private static void one(
      int inner, int columns, float[] a, int aAt, int aStep, float[] b, int bAt, float[] c, int cAt) {
    FloatVector sum = FloatVector.fromArray(SPECIES, c, cAt);
    for (int k = 0; k < inner; k++)
      sum =
          FloatVector.broadcast(SPECIES, a[aAt + k * aStep])
              .fma(FloatVector.fromArray(SPECIES, b, bAt + k * columns), sum);
    sum.intoArray(c, cAt);
  }

  /** Computes four rows of one vector each: four independent sums hide the latency of one. */
  private static void four(
      int inner, int columns, float[] a, int aAt, int aRow, int aStep, float[] b, int bAt, float[] c, int cAt) {
    FloatVector c0 = FloatVector.fromArray(SPECIES, c, cAt),
        c1 = FloatVector.fromArray(SPECIES, c, cAt + columns),
        c2 = FloatVector.fromArray(SPECIES, c, cAt + 2 * columns),
        c3 = FloatVector.fromArray(SPECIES, c, cAt + 3 * columns);
    for (int k = 0; k < inner; k++) {
      int at = aAt + k * aStep;
      FloatVector b0 = FloatVector.fromArray(SPECIES, b, bAt + k * columns);
      c0 = FloatVector.broadcast(SPECIES, a[at]).fma(b0, c0);
      c1 = FloatVector.broadcast(SPECIES, a[at + aRow]).fma(b0, c1);
      c2 = FloatVector.broadcast(SPECIES, a[at + 2 * aRow]).fma(b0, c2);
      c3 = FloatVector.broadcast(SPECIES, a[at + 3 * aRow]).fma(b0, c3);
    }
    c0.intoArray(c, cAt);
    c1.intoArray(c, cAt + columns);
    c2.intoArray(c, cAt + 2 * columns);
    c3.intoArray(c, cAt + 3 * columns);
  }

  /** Computes four rows of one column, in scalar arithmetic. */
  private static void column(
      int inner, int columns, float[] a, int aAt, int aRow, int aStep, float[] b, int bAt, float[] c, int cAt) {
    float c0 = c[cAt], c1 = c[cAt + columns], c2 = c[cAt + 2 * columns], c3 = c[cAt + 3 * columns];
    for (int k = 0; k < inner; k++) {
      int at = aAt + k * aStep;
      float b0 = b[bAt + k * columns];
      c0 = Math.fma(a[at], b0, c0);
      c1 = Math.fma(a[at + aRow], b0, c1);
      c2 = Math.fma(a[at + 2 * aRow], b0, c2);
      c3 = Math.fma(a[at + 3 * aRow], b0, c3);
    }
    c[cAt] = c0;
    c[cAt + columns] = c1;
    c[cAt + 2 * columns] = c2;
    c[cAt + 3 * columns] = c3;
  }
}
