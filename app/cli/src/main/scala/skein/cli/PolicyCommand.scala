package skein.cli

import java.nio.file.Path
import mainargs.{Flag, Leftover, ParserForClass, arg}
import skein.onnx.OnnxPolicy
import skein.report.{Section, TextTable}
import skein.scenario.Scenarios
import skein.settings.PolicyFile

/** Command-line options of `./skein policy`, with their help texts. */
final case class PolicyOptions(
    @arg(doc = "a policy file, or an ONNX file")
    file: Leftover[String],
    @arg(doc = "ONNX file to write its network into, for other programs; it is replaced")
    onnx: Option[String],
    @arg(doc = "policy file to write it into; replaced if it exists")
    conf: Option[String],
    @arg(doc = Shown.Doc)
    json: Flag
)

/** `./skein policy`: shows a policy file's content, and converts it to or from ONNX. */
final class PolicyCommand(using Scenarios)
    extends Command[PolicyOptions](
      "policy",
      "shows what a policy file contains, and converts networks to ONNX and back",
      ParserForClass[PolicyOptions]
    ):

  protected def execute(options: PolicyOptions): Either[String, Unit] =
    for
      file   <- only(options.file, "policy file", "./skein policy FILE --onnx OUT.onnx")
      policy <- PolicyFile.read(file)
      role  = PolicyFile.name(policy.role)
      shown = Shown(options.json.value)
      table = TextTable(
        Vector("<role", "<policy", "parameters"),
        Vector(Vector(role, policy.label, policy.parameters.size.toString))
      )
      _ = shown.tables(Seq(Section("Policy", table = Some(table))), s"$role ${policy.label}")
      _ <- options.onnx.fold(Right(())): out =>
        OnnxPolicy.write(
          policy.policy,
          role
        ).left.map(mistake => s"$file: $mistake").flatMap(written(shown, out, _))
      _ <- options.conf.fold(Right(())): out =>
        Either
          .cond(
            !policy.family.name.startsWith(OnnxPolicy.Prefix),
            policy.hocon(""),
            s"$file: only a network of ours can be a policy file; this one flies as the ONNX file that it is"
          )
          .flatMap(text => written(shown, out, text.getBytes(java.nio.charset.StandardCharsets.UTF_8)))
    yield ()

  private def written(shown: Shown, out: String, bytes: Array[Byte]): Either[String, Unit] =
    val file = Path.of(out).toAbsolutePath
    OutFolder.write(file.getParent, Seq(file.getFileName.toString -> bytes)).map(_ =>
      shown.say(s"written: $out")
    )
