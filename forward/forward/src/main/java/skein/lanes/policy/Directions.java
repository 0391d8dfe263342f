package skein.lanes.policy;

import java.util.Arrays;

/** Commanded headings of many worlds by the cosines and sines of their angles from north to east. */
public final class Directions {
  public float[] cos, sin;

  public Directions(int count) {
    cos = new float[count];
    sin = new float[count];
  }

  /** Ensures this capacity; discards all directions if it must grow. */
  public void reserve(int count) {
    if (cos.length < count) {
      cos = new float[count];
      sin = new float[count];
    }
  }

  public void fill(int from, int to, double headingRad) {
    Arrays.fill(cos, from, to, (float) StrictMath.cos(headingRad));
    Arrays.fill(sin, from, to, (float) StrictMath.sin(headingRad));
  }
}
