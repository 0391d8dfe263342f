package skein.lanes;

import java.util.Arrays;

/** Commanded headings of many worlds by the cosines and sines of their angles from north to east. */
final class Directions {
  float[] cos, sin;

  Directions(int count) {
    cos = new float[count];
    sin = new float[count];
  }

  /** Makes room for at least so many; forgets all if it has to grow. */
  void reserve(int count) {
    if (cos.length < count) {
      cos = new float[count];
      sin = new float[count];
    }
  }

  void fill(int from, int to, double headingRad) {
    Arrays.fill(cos, from, to, (float) StrictMath.cos(headingRad));
    Arrays.fill(sin, from, to, (float) StrictMath.sin(headingRad));
  }
}
