package skein.policy

/** Keeps a fixed offset from another vehicle, in the world frame.
  *
  * @param leader index of the other vehicle in the scenario
  * @param northM offset of the place north of the leader, m; `eastM` likewise
  * @param mostMps maximum commanded speed
  */
final case class Shadowing(
    leader: Int,
    northM: Double,
    eastM: Double,
    mostMps: Double,
    pursuit: Pursuit = Pursuit()
) extends Policy.Memoryless:

  def action(seen: Observation): Action =
    val self  = seen.self
    val north = pursuit.along(
      seen.northM(leader) + northM,
      seen.northMps(leader),
      seen.northM(self),
      seen.northMps(self)
    )
    val east = pursuit.along(
      seen.eastM(leader) + eastM,
      seen.eastMps(leader),
      seen.eastM(self),
      seen.eastMps(self)
    )
    Weave.level(seen, StrictMath.atan2(east, north), StrictMath.hypot(north, east).min(mostMps))
