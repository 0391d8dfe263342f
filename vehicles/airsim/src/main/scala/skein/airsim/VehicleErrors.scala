package skein.airsim

import skein.port.VehicleError
import skein.rpc.RpcError
import skein.signal.{Kinematics, Stamped}

private[skein] object VehicleErrors:

  val noReading: VehicleError = VehicleError.TimedOut("the vehicle's sensors have no reading")

  /** The reading that a port returns for a vehicle's state. */
  def reading(
      status: Either[RpcError, Stamped[VehicleStatus]]
  ): Either[VehicleError, Stamped[Kinematics]] =
    status.left.map(errorOf).filterOrElse(!_.value.isMissing, noReading).map(_.map(_.kinematics))

  /** Converts an RPC error to a vehicle's error. */
  def errorOf(error: RpcError): VehicleError = error match
    case _: RpcError.Timeout                       => VehicleError.TimedOut(error.message)
    case _: RpcError.Refused                       => VehicleError.Refused(error.message)
    case RpcError.ConnectionLost(_, mayHaveRun, _) => VehicleError.Lost(error.message, mayHaveRun)
    case _: RpcError.Malformed                     => VehicleError.Malformed(error.message)
    case _: RpcError.Overloaded                    => VehicleError.Overloaded(error.message)
    case _: RpcError.Cancelled                     => VehicleError.Cancelled(error.message)
    case _: RpcError.Unreachable                   => VehicleError.Unreachable(error.message)
