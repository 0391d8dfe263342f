package skein.policy

/** The evader in Isaacs' game of the homicidal chauffeur, which turns freely and is slower than a pursuer
  * with limited turn rate. With the evader at (x, y) in the pursuer's frame, y mirrored to the positive side,
  * R the pursuer's turning radius and γ the ratio of the evader's speed to the pursuer's:
  *
  *   - Ahead of the pursuer and nearer than the dodging distance, the evader breaks away at a right angle to
  *     the pursuer's heading and keeps that course while the pursuer turns after it, until the angle between
  *     them is arccos γ. This is the barrier's course that begins straight ahead of the pursuer: it begins
  *     γ·R ahead, the pursuer turns by arcsin γ meanwhile, and the evader slips by at R·(√(1 − γ²) + γ·arcsin
  *     γ − 1), which is the smallest capture radius with which the pursuer captures from everywhere.
  *   - Otherwise, inside the turning circle on its side, x² + (y − R)² < R², it heads for the circle's
  *     centre: a pursuer that turns as hard as it can stays at distance R from there, and must first fly away
  *     (the swerve).
  *   - Elsewhere it runs along the line on which the chase will end: the tangent of the turning circle
  *     through its position, away from the circle. A pursuer that turns as hard as it can and then dashes
  *     ends up on that line, whose direction does not change meanwhile.
  *
  * Exactly ahead of the pursuer or behind it, the evader chooses the right side. Source of the game, its
  * barrier, turn, dash and swerve: Isaacs, Differential Games (1965); the strategy against the swerve is
  * ours. `GuidanceSuite` tests the first and the last rule.
  *
  * @param speedRatio γ, in 0 to 1
  * @param dodgeM the dodging distance; 0 disables dodging. The ideal game's is γ·R = 4 m; vehicles with a lag
  *   need more.
  */
final case class ChauffeurEvader(turningRadiusM: Double = 8.0, speedRatio: Double = 0.5, dodgeM: Double = 4.0)
    extends HeadingPolicy.Memoryless:
  require(turningRadiusM > 0, s"the turning radius must be positive, got $turningRadiusM m")
  require(speedRatio >= 0 && speedRatio <= 1, s"the ratio of speeds must be in 0 to 1, got $speedRatio")

  /** The smallest angle that the evader keeps to the pursuer's heading while dodging, rad. */
  private val leastAside = StrictMath.acos(speedRatio)

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val cos    = StrictMath.cos(opponentHeadingRad)
    val sin    = StrictMath.sin(opponentHeadingRad)
    val x      = -dxM * cos - dyM * sin
    val signed = dxM * sin - dyM * cos
    val side   = if signed < 0 then -1.0 else 1.0
    if x > 0 && x * x + signed * signed < dodgeM * dodgeM then
      dodge(ownHeadingRad, opponentHeadingRad, side)
    else opponentHeadingRad + side * turn(x, turningRadiusM - side * signed)

  private def dodge(ownHeadingRad: Double, opponentHeadingRad: Double, side: Double): Double =
    val aside = math.IEEEremainder(ownHeadingRad - opponentHeadingRad, 2 * math.Pi)
    if math.abs(aside) >= leastAside && math.abs(aside) <= math.Pi / 2 + ChauffeurEvader.Rounding then
      ownHeadingRad
    // The evader does not turn back across the bow of a pursuer that has turned after it.
    else
      opponentHeadingRad + (if math.abs(aside) > leastAside / 2 then math.signum(aside)
                            else side) * math.Pi / 2

  /** Heading relative to the pursuer's, positive towards the evader's side, rad.
    *
    * @param toCentre lateral distance from the evader to the centre of the turning circle
    */
  private def turn(x: Double, toCentre: Double): Double =
    val square = x * x + toCentre * toCentre - turningRadiusM * turningRadiusM
    if square < 0 then StrictMath.atan2(toCentre, -x)
    // The direction from the centre to the tangent point is a quarter turn behind that of the tangent.
    else StrictMath.atan2(-toCentre, x) + StrictMath.atan2(turningRadiusM, math.sqrt(square))

object ChauffeurEvader:
  private val Rounding = 1e-9
