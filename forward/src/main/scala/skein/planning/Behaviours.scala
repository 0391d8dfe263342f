package skein.planning

import skein.simd.WorldRandom

/** Several ways in which a target may behave, against which every candidate is flown. */
object Behaviours:

  /** A target as it is taken to be, counting half, and others around it, drawn from a stream: elsewhere by about 0.2 m,
    * and, for the paper's evader, with another turning radius in mind, by about a tenth. The same stream gives the same
    * behaviours, so that all candidates of a tick meet the same.
    */
  def around(target: Target, count: Int, stream: Long): Vector[Behaviour] =
    require(count > 0, s"at least one behaviour is needed, came $count")
    val key                                                 = WorldRandom.key(stream, 0, 0)
    def drawn(variant: Int, place: Int, sd: Double): Double =
      Draws.normal(key, variant * PlacesPerVariant + place) * sd
    def variant(number: Int): Target = target match
      case evader: Target.Evader =>
        evader.copy(
          motion = evader.motion.copy(
            x = evader.motion.x + drawn(number, 0, PlaceSd),
            y = evader.motion.y + drawn(number, 1, PlaceSd)
          ),
          turningRadius = evader.turningRadius * (1 + drawn(number, 2, RadiusSd))
        )
      case along: Target.Along =>
        val (x, y) = (drawn(number, 0, PlaceSd), drawn(number, 1, PlaceSd))
        val track  = along.track
        along.copy(track =
          PredictedTrack(
            IArray.tabulate(track.steps)(track.x(_) + x),
            IArray.tabulate(track.steps)(track.y(_) + y)
          )
        )
    if count == 1 then Vector(Behaviour(target))
    else
      Behaviour(target, 0.5) +:
        Vector.tabulate(count - 1)(number => Behaviour(variant(number), 0.5 / (count - 1)))

  private val PlaceSd          = 0.2
  private val RadiusSd         = 0.1
  private val PlacesPerVariant = 4
