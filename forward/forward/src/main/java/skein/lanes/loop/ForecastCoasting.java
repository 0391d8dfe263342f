package skein.lanes.loop;

import static skein.simd.LaneMath.SPECIES;

import jdk.incubator.vector.FloatVector;
import skein.lanes.policy.LanePolicy;

/** Predicts constant velocity, as {@code skein.vehicle.ConstantVelocity} does. */
final class ForecastCoasting implements ForecastVehicles {
  private static final int WORLDS = LanePolicy.WORLDS;

  @Override
  public void predict(
      LaneVectors vectors, ForecastTrack way, float[] read, float[] into) {
    for (int k = 0; k < vectors.count; k++) {
      int i = vectors.first[k];
      FloatVector end = FloatVector.fromArray(SPECIES, way.endS, i),
          vx = FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_VX + i),
          vy = FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_VY + i);
      vx.fma(end, FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_X + i)).intoArray(into, i);
      vy.fma(end, FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_Y + i)).intoArray(into, WORLDS + i);
      vx.intoArray(into, 2 * WORLDS + i);
      vy.intoArray(into, 3 * WORLDS + i);
      if (into.length > 4 * WORLDS) {
        FloatVector vz = FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_VZ + i);
        vz.fma(end, FloatVector.fromArray(SPECIES, read, LaneVehicles.SEEN_Z + i)).intoArray(into, 4 * WORLDS + i);
        vz.intoArray(into, 5 * WORLDS + i);
      }
    }
  }
}
