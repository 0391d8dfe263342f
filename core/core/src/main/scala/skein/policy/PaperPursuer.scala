package skein.policy

/** The paper's pursuer: turns towards the evader's side, as hard as its turning circle allows.
  *
  * In the pursuer's frame (its last commanded heading is ahead), the evader at (x, y) gives the turn sign s =
  * sign(y); straight ahead s = 0, exactly behind s = 1. The new heading is θ + s·ω·elapsed.
  *
  * @param turnRateRadPerS ω. The paper's constants give (10 / 8)·0.08 rad every 100 ms = 1 rad/s; a turning
  *   circle of 8 m at 10 m/s would be 1.25 rad/s.
  * @param stepRad if set, every decision turns by s·stepRad whatever the time since the last, as the
  *   published code does (0.1 rad). Then the turn rate grows with the decision rate, which confounds the
  *   published comparison of loops.
  */
final case class PaperPursuer(turnRateRadPerS: Double = 1.0, stepRad: Option[Double] = None)
    extends HeadingPolicy.Memoryless:

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val cos  = StrictMath.cos(ownHeadingRad)
    val sin  = StrictMath.sin(ownHeadingRad)
    val x    = dxM * cos + dyM * sin
    val y    = -dxM * sin + dyM * cos
    val side = if y != 0 then math.signum(y) else if x < 0 then 1.0 else 0.0
    ownHeadingRad + side * (if stepRad.isDefined then stepRad.get else turnRateRadPerS * elapsedS)

object PaperPursuer:
  /** Turns a fixed angle per decision, as the published code does. */
  val asPublished: PaperPursuer = PaperPursuer(stepRad = Some(10.0 / 8.0 * 0.08))
