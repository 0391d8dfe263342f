package skein.policy

/** The pursuer in Isaacs' game of the homicidal chauffeur. Wherever capture is possible at all, it captures
  * every evader: it turns hard towards the evader and dashes. If the evader would slip by, it swerves
  * instead: it flies straight away until the evader is far enough for a turn towards it.
  *
  * The evader would slip by if [[HomicidalChauffeur.radiusNeededM]] exceeds a limit. For an evader ahead,
  * within the angle in which it can be run over, the limit is the capture radius; beyond, it decreases
  * linearly with the angle, to the smallest radius that captures for an evader behind. While the pursuer
  * turns, no evader can raise the radius that is needed, and the limit rises because the evader moves to the
  * front. So the pursuer does not alternate between the two, and the time between decisions does not undo the
  * gain of a swerve. Without that slack, an evader that stays on the barrier and crosses it by the length of
  * a step makes the pursuer swerve again and again.
  *
  * It captures, but not in the shortest time; for that strategy, in which the swerve turns away, see Merz,
  * The Homicidal Chauffeur (Stanford, 1971). At γ = 0.5 every pursuit in `HomicidalChauffeurSimulation` ends
  * within distance / (vP − vE) and 19 times turning radius / vP. Source of the game, its barrier and the
  * swerve: Isaacs, Differential Games (1965).
  *
  * @param speedRatio γ, the evader's speed over the pursuer's, in 0 to 1
  * @param captureRadiusM the capture radius; a value below 1.05 times [[HomicidalChauffeur.thresholdM]]
  *   counts as that
  * @param turnRateRadPerS maximum turn rate: speed over turning radius
  */
final case class ChauffeurPursuer(
    turningRadiusM: Double = 8.0,
    speedRatio: Double = 0.5,
    captureRadiusM: Double = 1.5,
    turnRateRadPerS: Double = 1.25
) extends HeadingPolicy.Memoryless:
  require(turnRateRadPerS > 0, s"the turn rate must be positive, got $turnRateRadPerS rad/s")

  private val game  = HomicidalChauffeur(turningRadiusM, speedRatio)
  private val most  = math.max(captureRadiusM, 1.05 * game.thresholdM)
  private val falls = (most - game.thresholdM) / (math.Pi - game.edgeRad)

  def heading(seen: PlanarObservation): Double =
    import seen.*
    val cos   = StrictMath.cos(ownHeadingRad)
    val sin   = StrictMath.sin(ownHeadingRad)
    val ahead = dxM * cos + dyM * sin
    val aside = -dxM * sin + dyM * cos
    val off   = math.abs(StrictMath.atan2(aside, ahead))
    val limit = most - falls * math.max(0.0, off - game.edgeRad)
    if game.radiusNeededM(ahead, aside) > limit then ownHeadingRad
    else Turn.towards(ownHeadingRad, StrictMath.atan2(dyM, dxM), turnRateRadPerS * elapsedS)
