package skein.policy

/** The geometry of Isaacs' game of the homicidal chauffeur: a pursuer of bounded turn rate against a slower
  * evader who turns freely. Distances in the pursuer's frame: `ahead` of it and `aside`, to either side.
  *
  * Its barriers are involutes. A pursuer who turns hard towards the evader's side follows a circle of radius
  * R about a centre beside it; with ρ the evader's distance from that centre, the evader does best to run
  * straight along the tangent of the circle of radius γ·R about the same centre. So it comes to the edge of
  * what lies ahead of the pursuer, at the angle arccos γ to its heading, when the pursuer has turned by τ,
  * and is then
  *
  * R·√(1 − γ²) + γ·R·τ − √(ρ² − γ²·R²)
  *
  * away, going round the pursuer as fast as the pursuer comes. Derived from the barrier's course backwards
  * from the edge of the usable part, Isaacs, Differential Games (1965); the involutes of one τ are the level
  * lines of this distance. `HomicidalChauffeurSimulation` simulates it.
  *
  * @param turningRadiusM R, of the pursuer
  * @param speedRatio γ, the evader's speed over the pursuer's, in 0 to 1
  */
final case class HomicidalChauffeur(turningRadiusM: Double, speedRatio: Double):
  require(turningRadiusM > 0, s"the turning radius must be positive, came $turningRadiusM m")
  require(speedRatio >= 0 && speedRatio <= 1, s"the ratio of speeds must be in 0 to 1, came $speedRatio")

  /** arccos γ: an evader at a smaller angle to the pursuer's heading cannot keep its distance. */
  val edgeRad: Double = StrictMath.acos(speedRatio)

  private val edgeSine    = math.sqrt(1 - speedRatio * speedRatio)
  private val innerRadius = speedRatio * turningRadiusM

  /** Above this capture radius the pursuer captures from everywhere, below it the evader escapes unless it
    * begins between the barriers: R·(√(1 − γ²) + γ·arcsin γ − 1). The two barriers touch there, straight
    * ahead, γ·R away.
    */
  val thresholdM: Double = turningRadiusM * (edgeSine + speedRatio * StrictMath.asin(speedRatio) - 1)

  /** The least capture radius with which a pursuer who turns hard towards this evader's side, and then
    * dashes, captures it whatever it does; infinite where the evader can wait at the turning circle's centre.
    * Far away it is negative.
    */
  def radiusNeededM(aheadM: Double, asideM: Double): Double =
    val beyond = math.abs(asideM) - turningRadiusM
    val square = beyond * beyond + aheadM * aheadM - innerRadius * innerRadius
    if square <= 0 then Double.PositiveInfinity
    else
      val tangent = math.sqrt(square)
      val turn = StrictMath.atan2(beyond, aheadM) + math.Pi - StrictMath.atan2(innerRadius, tangent) - edgeRad
      val turned = turn - 2 * math.Pi * math.floor(turn / (2 * math.Pi))
      turningRadiusM * edgeSine + innerRadius * turned - tangent
