"""What a layer can be exported as. A format takes the layer chunk by chunk and writes files of its own."""
