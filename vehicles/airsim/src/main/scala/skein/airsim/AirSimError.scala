package skein.airsim

import skein.link.Address
import skein.rpc.RpcError
import skein.units.Decimals.brief
import skein.units.Span

/** The reasons why a simulator's vehicle is not available: an expected failure, returned as a value. */
enum AirSimError:

  /** The simulator did not answer, or refused the call. */
  case Call(error: RpcError)

  /** The simulator has no vehicle of this name; `existing` lists its vehicles. */
  case UnknownVehicle(name: String, existing: Seq[String])

  /** The settings that the simulator sent cannot be read. */
  case Settings(error: SettingsError)

  def message: String = this match
    case Call(error)                    => error.message
    case UnknownVehicle(name, existing) => AirSimError.unknown(Seq(name), existing)
    case Settings(error)                => s"the simulator's settings: ${error.message}"

object AirSimError:
  /** One line that lists the missing vehicles and the vehicles that the simulator has. */
  def unknown(names: Seq[String], existing: Seq[String]): String =
    def listed(all: Seq[String]) = all.map(name => s"'$name'").mkString(", ")
    val has                      = if existing.isEmpty then "it has none" else s"it has ${listed(existing)}"
    s"the simulator has no vehicle ${listed(names)}; $has"

  /** Time-out of a first call: on a busy machine, a link that was just started needs seconds for it. */
  val FirstWithin: Span = Span.ofSeconds(15)

  /** Explains why a first call failed, when it is not yet known what listens at the address. */
  def ofFirst(error: RpcError, at: Address): String = error match
    case RpcError.Timeout(_, after) =>
      s"who listens at $at takes the connection, but has said nothing for ${after.toSeconds.brief} s; " +
        "expected AirSim or ./skein serve there"
    case other => other.message
