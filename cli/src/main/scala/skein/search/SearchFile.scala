package skein.search

import java.io.IOException
import java.nio.channels.FileChannel
import java.nio.file.{Files, Path, StandardCopyOption, StandardOpenOption}
import skein.optimise.{CmaEs, Course, Scored, SearchState, RunningStats}
import upickle.default.{ReadWriter, readwriter, writeJs, read as readJson, write as writeJson}

/** A search as it stands on disk: the question, and the state it has come to. */
final case class SearchFile(version: Int, question: SearchFile.Question, state: SearchState)

object SearchFile:
  val Name    = "search.json"
  val Version = 1

  type Question = SearchQuestion | TeamQuestion

  given ReadWriter[RunningStats]        = ReadWriter.derived
  private given ReadWriter[Scored]      = ReadWriter.derived
  private given ReadWriter[CmaEs.State] = ReadWriter.derived
  private given ReadWriter[Course]      = ReadWriter.derived
  private given ReadWriter[SearchState] = ReadWriter.derived
  given ReadWriter[Question]            = readwriter[ujson.Value].bimap(
    {
      case duel: SearchQuestion => writeJs(duel)
      case team: TeamQuestion   => writeJs(team)
    },
    json =>
      if json.obj.contains("scenario") then readJson[TeamQuestion](json) else readJson[SearchQuestion](json)
  )
  private given ReadWriter[SearchFile] = ReadWriter.derived

  def json(file: SearchFile): String = writeJson(file)

  def parse(text: String): Either[String, SearchFile] =
    try
      val version = ujson.read(text)("version").num.toInt
      if version != Version then Left(s"expected version $Version, came $version")
      else Right(readJson[SearchFile](text))
    catch case mistake: Exception => Left(s"expected the state of a search, came: ${mistake.getMessage}")

  /** Reads `search.json` of a folder.
    *
    * @return
    *   or why it cannot be gone on with
    */
  def read(folder: Path): Either[String, SearchFile] =
    val file = folder.resolve(Name)
    try parse(Files.readString(file)).left.map(mistake => s"$file: $mistake")
    catch case _: IOException => Left(s"cannot read $file: expected the folder of a search")

  /** Replaces `search.json` of a folder, so that whatever happens there is the old one or the new one. */
  def write(folder: Path, file: SearchFile): Either[String, Unit] =
    val target  = folder.resolve(Name)
    val written = folder.resolve(s"$Name.new")
    try
      Files.writeString(written, json(file))
      val channel = FileChannel.open(written, StandardOpenOption.WRITE)
      try channel.force(true)
      finally channel.close()
      Files.move(written, target, StandardCopyOption.ATOMIC_MOVE, StandardCopyOption.REPLACE_EXISTING)
      Right(())
    catch case failed: IOException => Left(s"cannot write $target: $failed")
