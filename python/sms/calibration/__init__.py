"""The mechanism as built: joints, lengths and sensors from measured poses (`sms calibrate geometry`)."""
