package skein.lanes;

import skein.vehicle.ReducedModel;
import skein.vehicle.PlantModel;

/** Predicts with lags and drag, piece by piece. The scalar reference is {@link PlantModel}. */
final class PredictedDragVehicles extends PredictedVehicles {
  private final LaneDragFlight flight;

  /**
   * @param speedMps of all commands
   */
  PredictedDragVehicles(ReducedModel model, double speedMps) {
    flight = new LaneDragFlight(model, speedMps);
  }

  @Override
  void predict(
      float[] seenX,
      float[] seenY,
      float[] seenVx,
      float[] seenVy,
      Directions sent,
      int reading,
      int into,
      Propagation propagation,
      boolean withVelocity) {
    System.arraycopy(seenX, reading, flight.x, 0, WORLDS);
    System.arraycopy(seenY, reading, flight.y, 0, WORLDS);
    System.arraycopy(seenVx, reading, flight.vx, 0, WORLDS);
    System.arraycopy(seenVy, reading, flight.vy, 0, WORLDS);
    for (Propagation.Part part : propagation.parts()) {
      if (part.command() == Propagation.Rest()) flight.rest();
      else flight.act(sent, part.command() * WORLDS);
      flight.fly((int) part.span(), (float) part.rest());
    }
    System.arraycopy(flight.x, 0, seenX, into, WORLDS);
    System.arraycopy(flight.y, 0, seenY, into, WORLDS);
    if (withVelocity) {
      System.arraycopy(flight.vx, 0, seenVx, into, WORLDS);
      System.arraycopy(flight.vy, 0, seenVy, into, WORLDS);
    }
  }
}
