package skein.lanes;

import skein.forward.Duelist;
import skein.vehicle.ReducedModel;

/**
 * Vehicles with lags along and across their commands and with quadratic drag ({@link
 * LaneDragFlight}). Their clock tells how many pieces end before a moment, and how long it is after
 * the last of these began.
 */
final class TimetableDragVehicles extends TimetableVehicles {
  private final LaneDragFlight flight;

  /** Whether a command has acted in this episode; until then they rest. */
  private boolean isCommanded;

  TimetableDragVehicles(Duelist duelist, ReducedModel model) {
    super(duelist);
    flight = new LaneDragFlight(model, duelist.speed());
  }

  @Override
  void start(int worlds) {
    flight.start(startX, startY);
    isCommanded = false;
  }

  @Override
  void rest(int world) {
    flight.rest(world, startX[world], startY[world]);
  }

  @Override
  void look(float[] times, int at, int into, boolean withVelocity) {
    flyTo(times, at);
    System.arraycopy(flight.x, 0, seenX, into, WORLDS);
    System.arraycopy(flight.y, 0, seenY, into, WORLDS);
    if (withVelocity) {
      System.arraycopy(flight.vx, 0, seenVx, into, WORLDS);
      System.arraycopy(flight.vy, 0, seenVy, into, WORLDS);
    }
  }

  @Override
  void act(float[] times, int at, Directions commanded, int from) {
    flyTo(times, at);
    isCommanded = true;
    flight.act(commanded, from);
  }

  private void flyTo(float[] times, int at) {
    if (isCommanded) flight.fly((int) times[at], times[at + 1]);
  }
}
