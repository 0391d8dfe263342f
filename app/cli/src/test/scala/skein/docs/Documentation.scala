package skein.docs

import java.nio.file.{Files, Path}
import skein.record.RecordingSchema

/** Documentation pages that code generates. */
object Documentation:
  val root: Path =
    Iterator
      .iterate(Path.of("").toAbsolutePath)(_.getParent)
      .find(path => Files.exists(path.resolve("build.sbt")))
      .get

  val hint = """write it anew with ./sbtw "cli/Test/runMain skein.docs.writeDocumentation""""

  /** The generated pages by path from the root. */
  val generated: Vector[(String, () => String)] = Vector(
    "docs/commands.md"      -> (() => CommandReference.markdown),
    "docs/configuration.md" -> (() => ConfigurationReference.markdown),
    "docs/recording.md"     -> (() => RecordingSchema.markdown)
  )

@main def writeDocumentation(): Unit =
  for (name, written) <- Documentation.generated do
    Files.writeString(Documentation.root.resolve(name), written())
    Console.out.println(s"wrote $name")
