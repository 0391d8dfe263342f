package skein.airsim

import skein.rpc.RpcError

/** Why a vehicle of a simulator is not at hand. Expected, so a value. */
enum AirSimError:

  /** The simulator did not answer, or refused. */
  case Call(error: RpcError)

  /** It has no vehicle of this name; `existing` are those it has. */
  case UnknownVehicle(name: String, existing: Seq[String])

  /** What it sent as its settings cannot be read. */
  case Settings(error: SettingsError)

  def message: String = this match
    case Call(error)                    => error.message
    case UnknownVehicle(name, existing) =>
      s"the simulator has no vehicle '$name'; it has ${existing.map(n => s"'$n'").mkString(", ")}"
    case Settings(error) => s"the simulator's settings: ${error.message}"
