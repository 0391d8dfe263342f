package skein.airsim

import skein.units.Metres
import upack.{Float32, Msg}

/** The distance on its path at which a vehicle aims. */
enum Lookahead:
  /** A distance in proportion to the speed, and farther while the vehicle is off the path: AirSim's default.
    */
  case Automatic

  case Fixed(distance: Metres)

  private[skein] def params: Seq[Msg] = this match
    case Automatic       => Seq(Float32(-1), Float32(1))
    case Fixed(distance) => Seq(Float32(distance.value.toFloat), Float32(0))
