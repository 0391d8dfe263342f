package skein.scenario

import java.lang.classfile.instruction.InvokeInstruction
import java.lang.classfile.{ClassFile, Instruction}
import scala.jdk.CollectionConverters.*
import scala.jdk.OptionConverters.*
import scala.util.Using

/** The condition by which a scenario ends before its duration.
  *
  * @throws OwnFailure if the scenario's code throws
  */
private[skein] final case class OwnEnd(scenario: Scenario) extends (Known => Boolean):
  def apply(known: Known): Boolean = Scenario.told(scenario.name)(scenario.isOver(known))

private[skein] object OwnEnd:
  /** None if the scenario does not define an end. */
  def of(scenario: Scenario): Option[OwnEnd] = Option.when(has(scenario))(OwnEnd(scenario))

  private def has(scenario: Scenario): Boolean =
    val declaring = scenario.getClass.getMethod("isOver", classOf[Known]).getDeclaringClass
    declaring != classOf[Scenario] && !forwards(declaring)

  /** Whether a class only inherits the method; the compiler then generates a method that calls the trait's
    * method.
    */
  private def forwards(declaring: Class[?]): Boolean =
    val file = s"/${declaring.getName.replace('.', '/')}.class"
    Using.resource(declaring.getResourceAsStream(file)): stream =>
      val methods = ClassFile.of().parse(stream.readAllBytes()).methods.asScala
      methods.filter(_.methodName.equalsString("isOver")).flatMap(_.code.toScala).forall: code =>
        val instructions = code.elementList.asScala.collect { case each: Instruction => each }
        // The four instructions load `this` and the argument, call the method, and return.
        instructions.size == 4 && instructions.exists:
          case call: InvokeInstruction => call.name.equalsString("isOver$")
          case _                       => false
