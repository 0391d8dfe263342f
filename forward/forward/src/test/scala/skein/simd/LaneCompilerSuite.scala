package skein.simd

import java.lang.classfile.instruction.{ConstantInstruction, InvokeInstruction, OperatorInstruction}
import java.lang.classfile.{ClassFile, Instruction, Opcode}
import scala.jdk.CollectionConverters.*
import skein.formula.{Op, Trace}

class LaneCompilerSuite extends munit.FunSuite:
  /** A pass over vectors of worlds must not load or store at an index that is only the loop's counter, or the
    * JVM may take seconds to compile it ([[LaneFunction.UNUSED]]).
    */
  for parameters <- 1 to 2 do
    test(s"no index is only the loop's counter, with parameters: $parameters"):
      val trace = Trace()
      val root  = trace.unary(Op.Sin, trace.add(trace.param(0), trace.input(0)))
      // Longer than a pass: the root is stored for the last.
      var sum = root
      for i <- 1 to 80 do sum = trace.unary(Op.Sqrt, trace.add(trace.unary(Op.Abs, sum), trace.const(i)))
      val bytes    = LaneCompiler.classFile(1, Vector(trace.add(sum, root)), 0, parameters, Vector.empty)
      val accesses =
        for
          method <- ClassFile.of().parse(bytes).methods.asScala.toVector
          if method.methodName.stringValue.startsWith("pass")
          instructions =
            method.code.get.elementList.asScala.collect { case each: Instruction => each }.toVector
          at <- instructions.indices
          if isAccess(instructions(at))
        yield instructions.slice(at - 2, at)
      assert(accesses.sizeIs > 5, accesses.size)
      for access <- accesses do
        access match
          case Vector(added, sum: OperatorInstruction) =>
            assertEquals(sum.opcode, Opcode.IADD)
            added match
              case constant: ConstantInstruction =>
                assertNotEquals(constant.constantValue, Integer.valueOf(0))
              case _ => ()
          case other => fail(s"no sum before the access: $other")

  private def isAccess(instruction: Instruction) = instruction match
    case call: InvokeInstruction => Set("fromArray", "intoArray")(call.name.stringValue)
    case _                       => false
