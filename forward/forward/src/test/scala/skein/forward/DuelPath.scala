package skein.forward

/** Tells where the evader and the pursuer of a duel are, once a period: s, then m north and east of either.
  */
final class DuelPath(told: (Double, Double, Double, Double, Double) => Unit) extends LoopObserver:
  private var evaderX, evaderY = 0.0

  override def scored(timeS: Double, vehicle: Int, x: Double, y: Double): Unit =
    if vehicle == 0 then
      evaderX = x; evaderY = y
    else told(timeS, evaderX, evaderY, x, y)
