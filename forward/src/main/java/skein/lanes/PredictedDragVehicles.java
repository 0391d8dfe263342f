package skein.lanes;

import skein.vehicle.ReducedModel;
import skein.vehicle.ReducedVehicleModel;

/** Predicts with lags and drag, piece by piece. The scalar reference is {@link ReducedVehicleModel}. */
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
      TimetableVehicles vehicles,
      Directions sent,
      int reading,
      int into,
      Courses courses,
      int course,
      boolean withVelocity) {
    System.arraycopy(vehicles.seenX, reading, flight.x, 0, WORLDS);
    System.arraycopy(vehicles.seenY, reading, flight.y, 0, WORLDS);
    System.arraycopy(vehicles.seenVx, reading, flight.vx, 0, WORLDS);
    System.arraycopy(vehicles.seenVy, reading, flight.vy, 0, WORLDS);
    for (int part = courses.start(course); part < courses.end(course); part++) {
      int place = courses.place(part);
      if (place == REST) flight.rest();
      else flight.act(sent, place * WORLDS);
      flight.fly((int) courses.span(part), courses.rest(part));
    }
    System.arraycopy(flight.x, 0, vehicles.seenX, into, WORLDS);
    System.arraycopy(flight.y, 0, vehicles.seenY, into, WORLDS);
    if (withVelocity) {
      System.arraycopy(flight.vx, 0, vehicles.seenVx, into, WORLDS);
      System.arraycopy(flight.vy, 0, vehicles.seenVy, into, WORLDS);
    }
  }
}
