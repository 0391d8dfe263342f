package skein.forward

/** Reports the positions of a duel's evader and pursuer once a period: time, s, then north and east of the
  * evader and of the pursuer, m.
  */
final class PaperPath(told: (Double, Double, Double, Double, Double) => Unit) extends LoopObserver:
  private var evaderX, evaderY = 0.0

  override def scored(timeS: Double, vehicle: Int, x: Double, y: Double, z: Double): Unit =
    if vehicle == 0 then
      evaderX = x; evaderY = y
    else told(timeS, evaderX, evaderY, x, y)
