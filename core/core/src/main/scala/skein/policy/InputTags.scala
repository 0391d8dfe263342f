package skein.policy

import scala.collection.mutable
import skein.signal.Kinematics
import skein.units.*

/** Identifiers of an example's inputs, for tracing: consecutive numbers from 0. Mutable. */
private[skein] final class InputTags:
  private val told = mutable.ArrayBuffer.empty[PolicyInput]

  def tag(input: PolicyInput): Double =
    told += input
    told.size - 1.0

  def span(input: PolicyInput): Span = Span.ofNanos(tag(input).toLong)

  /** A vehicle's estimate; models of vehicles have no attitude. */
  def seen(vehicle: Int, isPredicted: Boolean): Seen = Seen(
    Kinematics(
      vector(PolicyInput.Position(vehicle, _)),
      vector(PolicyInput.Velocity(vehicle, _)),
      Quaternion.Identity,
      Vector3.Zero
    ),
    span(PolicyInput.Age(vehicle)),
    isPredicted
  )

  private def vector(of: Int => PolicyInput) = Vector3(tag(of(0)), tag(of(1)), tag(of(2)))

  /** The inputs in the order of their tags. */
  def inputs: Vector[PolicyInput] = told.toVector

private[skein] object InputTags:
  private val attitude = "it reads the attitude, which models of vehicles do not tell"

  /** Fields of an estimate that a traced method must not read, each with the reason. */
  val Refused: Map[String, String] = Map(
    "Kinematics.orientation"        -> attitude,
    "Kinematics.angularVelocityFrd" -> attitude
  )
