package skein.formula

import java.lang.reflect.Field

/** The content of a local variable, a field or the operand stack during tracing. */
private[formula] sealed trait Value

private[formula] object Value:
  final case class Number(node: Node) extends Value

  /** An int or shorter integer, or a boolean as 1 or 0. It is known if its node is a constant. */
  final case class Whole(node: Node) extends Value

  /** A long whose value is known while tracing. */
  final case class Long(value: scala.Long) extends Value

  /** A long that depends on the inputs. It is a duration in nanoseconds, represented by its seconds. */
  final case class Time(seconds: Node) extends Value

  /** The result of `dcmpg` or `dcmpl`.
    *
    * @param ifUnordered the result if a number is NaN, 1 or −1
    */
  final case class Compared(a: Node, b: Node, ifUnordered: Int) extends Value

  /** An object that existed before tracing.
    *
    * @param path how it is reached from the object whose method is traced; None for shared objects
    */
  final case class Known(what: AnyRef, path: Option[Path]) extends Value

  /** An object, array or closure created by the traced method. */
  final case class Made(id: Int) extends Value

  final case class Boxed(value: Value) extends Value
  case object Null                     extends Value

  /** A value that may be passed on but not read.
    *
    * @param isWide whether it is a long or a double
    */
  final case class Unreadable(reason: String, isWide: Boolean) extends Value

  /** One of two values, chosen by a condition, that cannot be joined into one value. */
  final case class OneOf(condition: Node, yes: Value, no: Value) extends Value

  /** The value of an integer of at most 32 bits, or of a boolean as 1 or 0. */
  def wholeOf(simple: AnyRef): Int = simple match
    case number: java.lang.Number       => number.intValue
    case truth: java.lang.Boolean       => if truth then 1 else 0
    case character: java.lang.Character => character.charValue.toInt
    case other                          => throw IllegalArgumentException(other.toString)

/** The content of an object, array or closure created by the traced method. */
private[formula] enum Thing:
  case Record(className: String, fields: Map[String, Value])
  case Elements(values: Vector[Value], isFrozen: Boolean = false)
  case Closure(interface: String, method: String, impl: Thing.Impl, captured: Vector[Value])

  /** One of two objects, chosen by a condition. It can be read, but not changed. */
  case Either(className: String, fields: Map[String, Value])

private[formula] object Thing:
  /** The compiled method of a closure's body. */
  final case class Impl(owner: String, name: String, descriptor: String, kind: Kind)
  enum Kind:
    case Static, Instance, Constructor

/** A path from an object to a number or object inside it. */
private[formula] final case class Path(before: Option[Path], step: PathStep):
  /** Whether the path starts at an argument's example, and not at the object whose method is traced. */
  val isOfArgument: Boolean = before.fold(step.isInstanceOf[PathStep.Argument])(_.isOfArgument)

  override def toString: String = before.fold("")(_.toString) + (step match
    case PathStep.At(index)      => s"($index)"
    case PathStep.Of(field)      => (if before.isEmpty then "" else ".") + field.getName
    case PathStep.Argument(name) => name
    case PathStep.Itself         => "")

private[formula] enum PathStep:
  case Itself
  case Argument(name: String)
  case Of(field: Field)
  case At(index: Int)
