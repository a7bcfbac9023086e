"""Which sensitivity of the infrared camera suits a room."""
