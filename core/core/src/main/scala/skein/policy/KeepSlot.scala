package skein.policy

/** Keeps a place in the leader's frame. The first axis of that frame points along the circuit at the leader's
  * place, the second to the right; the frame turns as the leader moves along the circuit. The slot's velocity
  * is the leader's velocity plus turn rate × offset, so that in a turn the outer vehicles fly faster and the
  * inner ones slower. A lagging vehicle's deviation in a turn is compensated by lag × turn rate × the slot's
  * velocity.
  *
  * @param aheadM distance of the slot ahead of the leader
  * @param rightM distance of the slot to the right of the leader
  * @param lagS time constant with which vehicles follow their commands
  */
final case class KeepSlot(
    leader: Int,
    circuit: Racetrack,
    aheadM: Double,
    rightM: Double,
    mostMps: Double,
    lagS: Double,
    pursuit: Pursuit = Pursuit()
) extends Policy.Memoryless, Goal:

  override def isPlanar: Boolean = true

  def action(seen: Observation): Action =
    val self                      = seen.self
    val place                     = circuit.nearest(seen.northM(leader), seen.eastM(leader))
    val heading                   = circuit.headingRad(place)
    val (cos, sin)                = (StrictMath.cos(heading), StrictMath.sin(heading))
    val (northOffset, eastOffset) = (aheadM * cos - rightM * sin, aheadM * sin + rightM * cos)
    // Speed at which the place on the circuit moves while the leader flies to the side of the circuit.
    val (nearNorth, nearEast) = circuit.point(place)
    val toTheRightM  = -(seen.northM(leader) - nearNorth) * sin + (seen.eastM(leader) - nearEast) * cos
    val curvature    = circuit.curvaturePerM(place)
    val alongMps     = seen.northMps(leader) * cos + seen.eastMps(leader) * sin
    val turnRadps    = alongMps * curvature / (1 - curvature * toTheRightM).max(KeepSlot.LeastShare)
    val slotNorthMps = seen.northMps(leader) - turnRadps * eastOffset
    val slotEastMps  = seen.eastMps(leader) + turnRadps * northOffset
    seen.towards(
      pursuit.along(
        seen.northM(leader) + northOffset,
        slotNorthMps,
        seen.northM(self),
        seen.northMps(self)
      ) - lagS * turnRadps * slotEastMps,
      pursuit.along(
        seen.eastM(leader) + eastOffset,
        slotEastMps,
        seen.eastM(self),
        seen.eastMps(self)
      ) + lagS * turnRadps * slotNorthMps,
      mostMps
    )

  /** The future position of the slot, if the leader continues along the circuit at its present speed. */
  def wanted(seen: Observation, aheadS: Double): (Double, Double) =
    val here      = circuit.nearest(seen.northM(leader), seen.eastM(leader))
    val direction = circuit.headingRad(here)
    val alongMps  =
      seen.northMps(leader) * StrictMath.cos(direction) + seen.eastMps(leader) * StrictMath.sin(direction)
    val place                 = here + alongMps * aheadS
    val heading               = circuit.headingRad(place)
    val (cos, sin)            = (StrictMath.cos(heading), StrictMath.sin(heading))
    val (nearNorth, nearEast) = circuit.point(here)
    // The leader's distance to the right of the circuit stays constant.
    val beside = -(seen.northM(leader) - nearNorth) * StrictMath.sin(direction) +
      (seen.eastM(leader) - nearEast) * StrictMath.cos(direction) + rightM
    val (north, east) = circuit.point(place)
    (north + aheadM * cos - beside * sin, east + aheadM * sin + beside * cos)

object KeepSlot:
  /** Minimum of the fraction of the radius that scales the speed along the circuit. Near the centre of a turn
    * the nearest place on the circuit moves ever faster; this limits it to four times the speed.
    */
  private val LeastShare = 0.25
