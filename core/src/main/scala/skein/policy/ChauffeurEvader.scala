package skein.policy

/** The evader of Isaacs' homicidal chauffeur, who turns freely and is slower than a pursuer of bounded turn rate. With the
  * evader at (x, y) in the pursuer's frame, y mirrored to the positive side, R the pursuer's turning radius and γ the
  * evader's over the pursuer's speed:
  *
  *   - Inside the turning circle on its side, x² + (y − R)² < R², it heads for the circle's centre: there a pursuer that
  *     turns as hard as it can stays R away, and must first fly off (the swerve).
  *   - Ahead and nearer than the dodging distance, it steps aside at the angle arccos γ from the pursuer's heading: the
  *     direction in which every course of the barrier arrives, for there the evader runs along the normal of the capture
  *     circle at its edge of usable part, cos s = γ.
  *   - Elsewhere it runs along the line on which the chase will end: the tangent of the turning circle through its place,
  *     away from the circle. A pursuer who turns as hard as it can and then dashes comes onto that line, whose direction
  *     stays the same meanwhile: optimal against optimal pursuit where no barrier lies between them.
  *
  * Exactly ahead or behind it takes the right side. Sources: Isaacs, Differential Games (1965), sections 9.1 to 9.3 on the
  * barrier and its usable part and 10.2 on turn and dash; the first rule is his remark on the swerve, made a strategy.
  *
  * @param speedRatio
  *   γ, in 0 to 1
  * @param dodgeM
  *   the dodging distance; 0 never dodges. The ideal game needs little more than the capture radius, vehicles with a lag
  *   need about a turning radius.
  */
final case class ChauffeurEvader(turningRadiusM: Double = 8.0, speedRatio: Double = 0.5, dodgeM: Double = 8.0)
    extends Policy:
  require(turningRadiusM > 0, s"the turning radius must be positive, came $turningRadiusM m")
  require(speedRatio >= 0 && speedRatio <= 1, s"the ratio of speeds must be in 0 to 1, came $speedRatio")

  def heading(
      dxM: Double,
      dyM: Double,
      dvxMps: Double,
      dvyMps: Double,
      ownHeadingRad: Double,
      opponentHeadingRad: Double,
      elapsedS: Double
  ): Double =
    val cos      = math.cos(opponentHeadingRad)
    val sin      = math.sin(opponentHeadingRad)
    val x        = -dxM * cos - dyM * sin
    val signed   = dxM * sin - dyM * cos
    val side     = if signed < 0 then -1.0 else 1.0
    val y        = side * signed
    val toCentre = turningRadiusM - y
    val square   = x * x + toCentre * toCentre - turningRadiusM * turningRadiusM
    val turn     =
      if square < 0 then math.atan2(toCentre, -x)
      else if x > 0 && x * x + y * y < dodgeM * dodgeM then math.acos(speedRatio)
      // The tangent point's direction from the centre is a quarter turn behind that of the tangent.
      else math.atan2(-toCentre, x) + math.atan2(turningRadiusM, math.sqrt(square))
    opponentHeadingRad + side * turn
