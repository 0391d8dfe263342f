package skein.lanes.policy;

import java.util.Arrays;

/** Commanded headings of many worlds by the cosines and sines of their angles from north to east. */
public final class Directions {
  public float[] cos, sin;

  /** In space, the commanded altitude, m down, where {@code holds} is 1, or the velocity down, m/s, where it
   * is 0; null where vehicles fly level.
   */
  public float[] third, holds;

  public Directions(int count) {
    this(count, false);
  }

  public Directions(int count, boolean inSpace) {
    cos = new float[count];
    sin = new float[count];
    if (inSpace) {
      third = new float[count];
      holds = new float[count];
    }
  }

  /** Ensures this capacity; discards all directions if it must grow. */
  public void reserve(int count) {
    if (cos.length < count) {
      cos = new float[count];
      sin = new float[count];
      if (third != null) {
        third = new float[count];
        holds = new float[count];
      }
    }
  }

  /** Holds each world's altitude, m down, with all commands in space. */
  public void level(float[] down) {
    for (int at = 0; at < third.length; at += down.length)
      System.arraycopy(down, 0, third, at, down.length);
    Arrays.fill(holds, 1f);
  }

  /** Sets the directions of one of many worlds in all commands. */
  public void point(int world, int worlds, float cosOf, float sinOf) {
    for (int at = world; at < cos.length; at += worlds) {
      cos[at] = cosOf;
      sin[at] = sinOf;
    }
  }

  /** Holds the altitude of one of many worlds, m down, with all commands in space. */
  public void level(int world, int worlds, float down) {
    for (int at = world; at < third.length; at += worlds) {
      third[at] = down;
      holds[at] = 1f;
    }
  }

  public void fill(int from, int to, double headingRad) {
    Arrays.fill(cos, from, to, (float) StrictMath.cos(headingRad));
    Arrays.fill(sin, from, to, (float) StrictMath.sin(headingRad));
  }
}
